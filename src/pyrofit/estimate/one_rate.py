"""Parameters that tests at one heating rate do not tell.

A faster reaction of a lower activation energy E or of another order gives nearly the same record at
one rate (kinetic compensation; Vyazovkin et al. 2011, doi 10.1016/j.tca.2011.03.034, ask for three
to five rates). E then follows from the order that the model assumes, however well it fits.
"""

from collections.abc import Iterable

from pyrofit.config.uses import numbers_in_keys
from pyrofit.estimate.problem import Problem
from pyrofit.model.base import named_by
from pyrofit.model.experiment import Experiment
from pyrofit.model.heated import HeatedExperiment

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
