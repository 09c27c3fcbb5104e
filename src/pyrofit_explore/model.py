"""A study with some effects switched on, simulated at all its measured points."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from pyrofit.api.choices import Key, Place, places_of_parameter, used_by
from pyrofit.config import Study, TermSpec, calibration_channels, parameters_in
from pyrofit.config.resolve import diagnosed_material
from pyrofit.effects import known_effects
from pyrofit.effects.apply import with_effects
from pyrofit.errors import StudyError
from pyrofit.estimate.pose import of_diagnosis, pose
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.targets import Measurements
from pyrofit.model.parameters import Parameter
from pyrofit.solver.arrays import FloatArray, Values
from pyrofit.solver.curves import Curves


@dataclass(frozen=True)
class Simulated:
    """Curves of one set.

    Parameters
    ----------
    models
        The model at the points of each term of the problem, SI units; NaN where no run finished.
    runs
        How each experiment ended.
    """

    models: list[FloatArray]
    runs: Mapping[str, Curves]

    @property
    def failed(self) -> dict[str, str]:
        """Why runs did not finish, by experiment."""
        ended = {name: run.status for name, run in self.runs.items()}
        return {name: end.explanation for name, end in ended.items() if not end.finished}


@dataclass(frozen=True, eq=False)
class ExploredModel:
    """A study with effects, posed.

    Parameters
    ----------
    study
        The study; the numbers of its effects are parameters ``<effect>_<number>``.
    problem
        Its terms are all signals, the fitted ones first, then the terms of the costs.
    signals
        Experiment and signal of the first terms.
    fitted
        Number of signals that are fitted; the others are held out.
    costs
        Positions of the terms of each cost function.
    """

    study: Study
    problem: Problem
    signals: tuple[Key, ...]
    fitted: int
    costs: Mapping[str, range]
    _last: dict[str, tuple[tuple[float | None, ...], Curves]] = field(
        init=False, repr=False, default_factory=dict
    )
    """Of each experiment the values that it was simulated with last, and its curves."""

    @cached_property
    def places(self) -> list[Place]:
        """The places of the description at which a parameter stands."""
        return places_of_parameter(self.study)

    @cached_property
    def _uses(self) -> dict[str, list[str]]:
        """The parameters that each experiment shows; of equal repeats the first stands for all."""
        distinct = dict.fromkeys(self.problem.alike.values())
        return {name: sorted(used_by(self.study, [name])) for name in distinct}

    def simulate(self, values: Mapping[str, float]) -> Simulated:
        """Return all curves for SI values of parameters; others have those of the study.

        Only experiments are simulated whose values are others than the last time.
        """
        problem = self.problem
        every = {**problem.fixed, **values}
        asked = {n: tuple(every.get(p) for p in used) for n, used in self._uses.items()}
        kept = self._last.copy().items()
        found = {n: one for n, one in kept if one[0] == asked[n] and one[1].status.finished}
        new = [n for n in asked if n not in found]
        for n, curves in problem.simulated(every, 1, new).items():
            found[n] = asked[n], curves[0]
        self._last.update(found)
        return self._picked({n: found[first][1] for n, first in problem.alike.items()})

    def simulate_all(self, values: Values, sets: int) -> list[Simulated]:
        """Return the same of several sets; a value is a number or has the shape (sets,)."""
        found = self.problem.simulated({**self.problem.fixed, **values}, sets)
        return [self._picked({n: curves[i] for n, curves in found.items()}) for i in range(sets)]

    def _picked(self, runs: Mapping[str, Curves]) -> Simulated:
        done = {name: run.signals for name, run in runs.items() if run.status.finished}
        models = [
            done[name][signal][index] if name in done else np.full(index.size, np.nan)
            for name, signal, index in self.problem.picks
        ]
        return Simulated(models, runs)

    def target(self, channel: int) -> FloatArray:
        """Return the measured values of a signal, SI units."""
        return self.problem.cost.terms[channel][1].target.value


def effect_parameters(effects: Collection[str]) -> dict[str, Parameter]:
    """Return the parameters of effects: their strengths, and the numbers of their form.

    >>> list(effect_parameters(["flux_spread"]))
    ['flux_spread_spread']
    """
    return {
        f"{name}_{key}": Parameter(unit=q.unit, lower=q.lower, upper=q.upper, label=q.label)
        for name in effects
        for key, q in known_effects()[name].quantities.items()
    }


def switched(study: Study, effects: Collection[str]) -> Study:
    """Return a study that has these effects besides its own.

    Raises
    ------
    StudyError
        An effect is unknown, or the description cannot have it.
    """
    if not effects:
        return study
    catalogue = known_effects()
    chosen = {
        name: {key: f"{name}_{key}" for key in catalogue[name].quantities}
        for name in effects
        if name in catalogue
    }
    try:
        asked = {name: chosen.get(name, {}) for name in effects}
        material, experiments = with_effects(study.material, study.experiments, asked)
    except ValueError as error:
        raise StudyError(f"study '{study.name}': {error}") from None
    return study.model_copy(
        update={
            "material": material,
            "experiments": experiments,
            "parameters": {**study.parameters, **effect_parameters(effects)},
            "with_effects": {**study.with_effects, **chosen},
        }
    )


def possible_effects(study: Study) -> list[str]:
    """Return the effects of the catalogue that the description can have."""
    found = []
    for name in known_effects():
        try:
            switched(study, [name])
        except StudyError:
            continue
        found.append(name)
    return found


def pose_model(
    study: Study, measurements: Measurements, effects: Collection[str] = ()
) -> ExploredModel:
    """Pose a study with effects: all its signals and all terms of its costs in one problem.

    Raises
    ------
    StudyError
        The description cannot have an effect.
    CostError
        A cost does not fit its target.
    """
    study = switched(study, effects)
    fitted = [(c.experiment, c.signal) for c in calibration_channels(study)]
    keys = [*dict.fromkeys(fitted), *(key for key in measurements if key not in fitted)]
    terms = [TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in keys]
    costs = {}
    for name, of_cost in study.imp.costs.items():
        costs[name] = range(len(terms), len(terms) + len(of_cost))
        terms += of_cost
    asked = of_diagnosis(study, terms, free_parameters(study))
    problem = pose(study, asked, measurements, study.fixed_values())
    return ExploredModel(study, problem, tuple(keys), len(set(fitted)), costs)


def free_parameters(study: Study) -> list[str]:
    """Return the parameters with limits that the description uses, in the order of the study."""
    used = parameters_in(diagnosed_material(study), *study.experiments.values())
    return [n for n, p in study.parameters.items() if p.lower is not None and n in used]
