"""Best set, mean and standard deviation of each parameter over the repetitions of SCE-UA."""

from dataclasses import dataclass

import pandas as pd

from pyrofit.analysis.best_sets import at_bound
from pyrofit.analysis.optimisers import lowest_of
from pyrofit.config import Study

FIT = "fit"
"""Name under which the cost itself stands."""
WIDE_SPREAD = 0.20
"""A sigma above this fraction of the search range says that the data do not determine it."""


@dataclass(frozen=True)
class OverRepetitions:
    """A parameter, or the cost, over the repetitions of one cost function.

    Parameters
    ----------
    cost_function, name
        Cost function, and the parameter or `FIT`.
    best, mean, sigma
        Value of the best set; mean and standard deviation over n repetitions, with n - 1 as
        divisor, in the parameter's unit.
    lower, upper
        Limits of the search; none of the cost.
    """

    cost_function: str
    name: str
    best: float
    mean: float
    sigma: float
    lower: float | None
    upper: float | None

    @property
    def bound(self) -> str:
        """'lower' or 'upper' where the best value is at a limit, else empty."""
        if self.lower is None or self.upper is None:
            return ""
        return at_bound(self.best, self.lower, self.upper)

    @property
    def is_wide(self) -> bool:
        """Whether sigma exceeds `WIDE_SPREAD` of the search range."""
        if self.lower is None or self.upper is None:
            return False
        return self.sigma > WIDE_SPREAD * (self.upper - self.lower)


def repeated(study: Study, repetitions: pd.DataFrame) -> list[OverRepetitions]:
    """Return the cost and the parameters of every cost function."""
    found = []
    for cost in study.imp.costs:
        group = repetitions[repetitions["cost_function"] == cost]
        best = lowest_of(group)
        found.append(_of(cost, FIT, group["cost"], float(best["cost"]), (None, None)))
        for name in study.imp.estimate:
            factor, limits = study.parameters[name].factor, study.search_limits(name)
            found.append(_of(cost, name, group[name] / factor, float(best[name]) / factor, limits))
    return found


def _of(
    cost: str,
    name: str,
    values: pd.Series,
    best: float,
    limits: tuple[float | None, float | None],
) -> OverRepetitions:
    return OverRepetitions(
        cost, name, best, float(values.mean()), float(values.std(ddof=1)), *limits
    )
