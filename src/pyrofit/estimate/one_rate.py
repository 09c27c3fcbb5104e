"""Parameters that tests at one heating rate do not tell.

A faster reaction of a lower activation energy E or of another order gives nearly the same record at
one rate (kinetic compensation; Vyazovkin et al. 2011, doi 10.1016/j.tca.2011.03.034, ask for three
to five rates). E then follows from the order that the model assumes, however well it fits.
"""

from collections.abc import Iterable, Sequence

import numpy as np

from pyrofit.config.uses import numbers_in_keys
from pyrofit.estimate.problem import Problem
from pyrofit.model.base import named_by
from pyrofit.model.experiment import Experiment
from pyrofit.model.heated import HeatedExperiment
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

BEYOND = 0.1
"""How far a parameter may move that tests do not tell, as a fraction of the search range."""
HALF = 0.5
"""Share of the variance of a parameter that follows from those of `following_from_the_model` from
which on it follows from the model as well."""
ALIKE = 1.5
"""Largest ratio of heating rates that count as one."""
COMPENSATING = "E_J_mol", "order", "catalysis", "A_1_s", "reference_rate_1_s"
"""Keys of a reaction whose numbers make up for one another at one rate."""


def following_from_the_model(problem: Problem, known: Iterable[int] = ()) -> list[int]:
    """Return the positions of the parameters that tests at one heating rate do not tell.

    It is empty where a slab or another rate is fitted as well, and has no ``known`` parameters.
    """
    if not at_one_rate([run.experiment for run in problem.runs.values()]):
        return []
    names = {n for x in numbers_in_keys(problem.material, COMPENSATING) for n in named_by(x)}
    return [i for i, n in enumerate(problem.names) if n in names and i not in set(known)]


def follows_with(i: int, assumed: Sequence[int], covariance: FloatArray, reach: float) -> bool:
    """Tell whether a parameter follows from assumed ones: it is one, or moves with them.

    It moves with them if one of them that moves by `BEYOND` takes it out of its interval. It also
    does if at least `HALF` of its variance c_ii is c_iS C_SS^-1 c_Si, S the assumed ones.

    Parameters
    ----------
    i, assumed
        Positions in the covariance.
    covariance
        C, shape (parameters, parameters).
    reach
        Distance from the estimate to the farther end of the interval.
    """
    if i in assumed or not assumed:
        return i in assumed
    own, shared = float(covariance[i, i]), covariance[i, assumed]
    moved = BEYOND * shared / np.diag(covariance)[assumed]
    explained = linear.dot(shared, linear.solve(covariance[np.ix_(assumed, assumed)], shared))
    return bool(np.any(np.abs(moved) > reach)) or explained >= HALF * own


def at_one_rate(experiments: Iterable[Experiment]) -> bool:
    """Tell whether all experiments are samples heated by one programme, or held at one temperature.

    Rates within a factor of `ALIKE` are one.
    """
    held: set[float | None] = set()
    rates = []
    for experiment in experiments:
        if not isinstance(experiment, HeatedExperiment):
            return False
        held.add(experiment.set_point_K)
        rates.append(experiment.heating_rate_K_min)
    return len(held) == 1 and (None not in held or max(rates) <= ALIKE * min(rates))
