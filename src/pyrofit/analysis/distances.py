"""How far the optimisers' sets are from the optimum of the likelihood."""

from dataclasses import dataclass

import numpy as np

from pyrofit.config import Study
from pyrofit.constants import QUANTILE
from pyrofit.results.identification import Identified


@dataclass(frozen=True)
class Distance:
    """A set of one cost function beside the optimum, in standard deviations of the parameters.

    Parameters
    ----------
    cost_function, set
        Cost function, and which of its sets: of which optimiser, the best or the mean.
    chi2_per_freedom
        Chi-square of the set per degree of freedom.
    within
        Parameters inside their 95 % interval.
    farthest, distance_sd
        The parameter that is farthest from the optimum, and its distance.
    """

    cost_function: str
    set: str
    chi2_per_freedom: float
    within: int
    farthest: str
    distance_sd: float


def distances(study: Study, identified: Identified) -> list[Distance]:
    """Return the distances of all sets, in the study's order of cost functions."""
    names = list(study.imp.estimate)
    freedom = identified.noise["imp"].freedom
    found = []
    for row in identified.sets.to_dict("records"):
        away = np.abs([float(row[name]) for name in names])
        found.append(
            Distance(
                cost_function=row["cost_function"],
                set=row["set"],
                chi2_per_freedom=float(row["chi2"]) / freedom,
                within=int((away <= QUANTILE).sum()),
                farthest=names[int(away.argmax())],
                distance_sd=float(away.max()),
            )
        )
    return found
