"""Draws from the posterior of the parameters, and every experiment predicted with bands."""

from pyrofit.steps.base import Step

STEP = Step(
    place=40,
    words="sample the parameters of a finished study; predict with bands, write an ensemble",
    message="Parameters drawn from the posterior, and predictions with bands",
    threads=2,
)
