"""Every stored call scored again under any cost: which costs rank the sets alike."""

from pyrofit.steps.base import Step

STEP = Step(
    place=20,
    words="score the stored sets of a finished study again under any cost",
    message="Stored sets scored again under other costs",
    threads=2,
)
