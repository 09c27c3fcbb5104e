"""By how much planned tests would narrow parameters and predictions."""

from pyrofit.steps.base import Step

STEP = Step(
    place=50,
    words="by how much planned tests would narrow parameters and predictions",
    message="Worth of planned tests",
    threads=2,
)
