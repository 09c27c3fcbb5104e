"""Data against limits, before any fit: what no set within the limits reaches, and why."""

from pyrofit.steps.base import Step

STEP = Step(
    place=5,
    words="compare the data with all that the limits allow, before any fit",
    message="Data against limits, before any fit",
    page="",
    early=True,
)
