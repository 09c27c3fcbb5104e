"""A free correction: a handful of coefficients, zero where nothing is corrected."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from pyrofit.effects.base import changed
from pyrofit.estimate.problem import Outcome, Problem
from pyrofit.model.slab import SlabExperiment
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.arrays import Values as Sets

Shape = list[tuple[float, float]]
Values = Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Correction:
    """A correction before its fit.

    ``sd`` are the standard deviations of the coefficients' priors by name. ``problem`` is the
    problem with the coefficients in its description. ``shape`` returns the curve to draw from the
    values of all parameters.
    """

    probe: str
    what: str
    unit: str
    sd: dict[str, float]
    problem: Problem
    shape: Callable[[Values], Shape]


@dataclass(frozen=True)
class Derived(Problem):
    """A problem of which some numbers are made of the described ones and of coefficients."""

    derive: Callable[[Values], Values]

    @property
    def moving(self) -> tuple[int, ...]:
        """All positions: derived values may use each of them."""
        return tuple(range(len(self.names)))

    def outcomes(self, values: Sets, sets: int, led: bool = False) -> list[Outcome]:
        """Return how each set ended and its models, derived values included."""
        columns = {name: np.broadcast_to(value, sets) for name, value in values.items()}
        each = [
            self.derive({name: float(column[s]) for name, column in columns.items()})
            for s in range(sets)
        ]
        made = {name: np.array([one[name] for one in each]) for name in each[0]}
        return Problem.outcomes(self, {**values, **made}, sets, led)


def derived(
    problem: Problem,
    changes: Mapping[str, Mapping[str, Any]],
    derive: Callable[[Values], Values],
) -> Problem:
    """Return the problem with names in its description, by experiment and key, and their values."""
    runs = dict(problem.runs)
    for name, update in changes.items():
        runs[name] = replace(runs[name], experiment=_changed(slabs_of(problem)[name], update))
    parts = {field.name: getattr(problem, field.name) for field in fields(Problem)}
    return Derived(**{**parts, "runs": runs}, derive=derive)


def _changed(part: Any, update: Mapping[str, Any]) -> Any:
    """Return a part of a description with other values, in the parts of it as well."""
    inner = {
        key: _changed(getattr(part, key), value) if isinstance(value, Mapping) else value
        for key, value in update.items()
    }
    return changed(part, **inner)


def coefficient_names(probe: str, count: int) -> tuple[str, ...]:
    """Return the names of a correction's coefficients."""
    return tuple(f"probe_{probe}_{k}" for k in range(count))


def slabs_of(problem: Problem) -> dict[str, SlabExperiment]:
    """Return the experiments on slabs by name."""
    found = {name: run.experiment for name, run in problem.runs.items()}
    return {name: e for name, e in found.items() if isinstance(e, SlabExperiment)}


def times_of_record(problem: Problem) -> dict[str, FloatArray]:
    """Return the times of a record of each gasification."""
    return {
        name: next(iter(problem.runs[name].requests.values())).time_s for name in slabs_of(problem)
    }
