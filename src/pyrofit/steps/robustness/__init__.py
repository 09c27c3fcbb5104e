"""How robust the cost functions are: fits to twins of known truth, with noise and outliers."""

from pyrofit.steps.base import Step

STEP = Step(
    place=10,
    words="compare the costs on twins of known truth",
    message="Robustness of the cost functions: table and figure",
    part="cost",
    part_message="Robustness, {wildcards.part}",
)
