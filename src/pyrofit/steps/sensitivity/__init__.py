"""Variance-based sensitivity of signals and costs, over time."""

from pyrofit.steps.base import Step

STEP = Step(
    place=30,
    words="variance-based sensitivity of signals over time and of costs",
    message="Sensitivity of signals over time and of costs",
    threads=2,
)
