"""A model on trial: the base with some effects of the catalogue, against some channels."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from pyrofit.cost import WeightedSum
from pyrofit.diagnose.base.journal import Journal
from pyrofit.diagnose.base.plausible import Plausible
from pyrofit.diagnose.settings import Settings
from pyrofit.effects import known_effects
from pyrofit.effects.apply import own_laboratories, with_effects
from pyrofit.effects.base import Chosen, Quantity
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.problem import Problem
from pyrofit.experiments import kind_of
from pyrofit.solver.arrays import FloatArray

Free = Mapping[str, tuple[str, ...]]
"""By effect, those of its parameters that are fitted, the strength first."""


@dataclass(frozen=True, eq=False)
class Base:
    """The likelihood and the calibrated channels, which all models on trial share.

    Parameters
    ----------
    likelihood
        All channels, calibrated and held out, under the base model, and the known values of its
        parameters.
    calibrated
        Positions of the calibrated channels; the others are held out.
    plausible
        Plausible ranges of strengths, by effect.
    of_small_samples
        Effects that TGA, DSC and MCC ask for without the slab.
    journal
        Keeps descents for the case that the diagnosis is broken off.
    settings
        Numbers that steer the diagnosis.
    """

    likelihood: Likelihood
    calibrated: tuple[int, ...]
    plausible: Mapping[str, Plausible] = field(default_factory=dict)
    of_small_samples: tuple[str, ...] = ()
    journal: Journal | None = None
    settings: Settings = Settings()

    @property
    def held_out(self) -> tuple[int, ...]:
        """Positions of the channels that are predicted only."""
        count = len(self.likelihood.noise)
        return tuple(i for i in range(count) if i not in self.calibrated)

    def shows_the_slab(self, channel: int) -> bool:
        """Tell whether a channel is of a slab, not of a small sample."""
        name, _ = self.channels[channel]
        return kind_of(self.likelihood.problem.runs[name].experiment).stage == "imp"

    @property
    def channels(self) -> list[tuple[str, str]]:
        """Experiment and signal of every channel."""
        return [(name, signal) for name, signal, _ in self.likelihood.problem.picks]


@dataclass(frozen=True, eq=False)
class Model:
    """Base and effects against some channels; x are fractions of the search range."""

    base: Base
    effects: Free
    channels: tuple[int, ...]
    likelihood: Likelihood
    """Of these channels; the effects' parameters follow those of the base."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all fitted parameters."""
        return self.likelihood.problem.names

    @property
    def points(self) -> int:
        """Number of measured points."""
        return sum(self.likelihood.points)

    @property
    def idle(self) -> tuple[int, ...]:
        """Positions of the parameters that no run of these channels uses."""
        return self.likelihood.problem.idle

    def with_idle_known(self, x: FloatArray, fixed: int | None = None) -> FloatArray:
        """Return x with known values of the idle ones; ``fixed`` keeps its value."""
        return self.likelihood.with_idle_known(x, fixed)

    def position(self, effect: str) -> int:
        """Return the position of an effect's strength among the parameters."""
        return self.names.index(name_of(effect, strength_of(effect)[0]))

    @property
    def absent(self) -> int:
        """Number of rows of effects that have a plausible range, but are not in the model."""
        return sum(effect not in self.effects for effect in self.base.plausible)

    def residuals(self, x: FloatArray) -> FloatArray:
        """Return the whitened residuals of the channels, of known values, of plausible strengths.

        All models have a row for each effect with a plausible range, zero where it is absent.
        """
        return self.residuals_all(x[None])[0]

    def residuals_all(self, X: FloatArray) -> list[FloatArray]:
        """Return the whitened residuals of several sets, X of shape (sets, parameters)."""
        rows = np.zeros((len(X), len(self.base.plausible)))
        for k, i, plausible in self._strengths:
            rows[:, k] = plausible.residuals(self._strength(X, i))
        own = self.likelihood.residuals_all(X)
        return [np.concatenate([r, row]) for r, row in zip(own, rows, strict=True)]

    def jacobian(self, x: FloatArray, residuals: FloatArray) -> FloatArray:
        """Return d residuals / d x."""
        rows = np.zeros((len(self.base.plausible), x.size))
        for k, i, plausible in self._strengths:
            slope = plausible.slopes(self._strength(x[None], i))[0]
            rows[k, i] = slope * self.likelihood.problem.span[i]
        own = residuals[: residuals.size - len(rows)]
        return np.vstack([self.likelihood.jacobian(x, own), rows])

    @property
    def _strengths(self) -> list[tuple[int, int, Plausible]]:
        """Row, position among the parameters, and range of each strength that has one."""
        return [
            (k, self.position(effect), plausible)
            for k, (effect, plausible) in enumerate(self.base.plausible.items())
            if effect in self.effects
        ]

    def _strength(self, X: FloatArray, i: int) -> FloatArray:
        problem = self.likelihood.problem
        return np.asarray(problem.lower[i] + X[:, i] * problem.span[i])

    def finished(self, residuals: FloatArray) -> bool:
        """Tell whether all runs finished that some residuals come from."""
        return self.likelihood.finished(residuals)

    def by_channel(self, residuals: FloatArray) -> list[FloatArray]:
        """Split whitened residuals by channel; those of the known values are left out."""
        return self.likelihood.split(residuals)


def model_of(base: Base, effects: Free, channels: Sequence[int] | None = None) -> Model:
    """Return the base with effects against channels, by default the calibrated ones.

    Raises
    ------
    ValueError
        The description cannot have an effect.
    """
    channels = base.calibrated if channels is None else tuple(channels)
    problem = _with_effects(base, effects)
    noise = tuple(base.likelihood.noise[i] for i in channels)
    likelihood = Likelihood(_restricted(problem, channels), noise, base.likelihood.prior)
    return Model(base, effects, channels, likelihood)


def _with_effects(base: Base, effects: Free) -> Problem:
    problem, catalogue = base.likelihood.problem, known_effects()
    chosen: dict[str, Chosen] = {
        name: {**{p: name_of(name, p) for p in free}, **laboratories_of(base, name)}
        for name, free in effects.items()
    }
    experiments = {name: run.experiment for name, run in problem.runs.items()}
    material, changed = with_effects(problem.material, experiments, chosen)
    added = [(name, p) for name, free in effects.items() for p in free]
    limits = [catalogue[name].quantities[p] for name, p in added]
    return replace(
        problem,
        names=(*problem.names, *(name_of(name, p) for name, p in added)),
        lower=np.append(problem.lower, [q.lower for q in limits]),
        upper=np.append(problem.upper, [q.upper for q in limits]),
        material=material,
        runs={n: replace(run, experiment=changed[n]) for n, run in problem.runs.items()},
    )


def laboratories_of(base: Base, effect: str) -> dict[str, tuple[str, ...]]:
    """Return the key that names the laboratories to which an effect belongs.

    Effects of apparatus and surroundings belong to all calibrated laboratories together; those held
    out keep their own. The key is empty where the effect belongs to all experiments.
    """
    if known_effects()[effect].is_shared:
        return {}
    runs = base.likelihood.problem.runs
    fitted = [runs[base.channels[i][0]].experiment for i in base.calibrated]
    return own_laboratories(fitted, [run.experiment for run in runs.values()])


def _restricted(problem: Problem, channels: Sequence[int]) -> Problem:
    """Return the problem with some of its terms, in that order, and the runs they need."""
    picks = tuple(problem.picks[i] for i in channels)
    wanted = {(name, signal) for name, signal, _ in picks}
    runs = {}
    for name, run in problem.runs.items():
        requests = {s: r for s, r in run.requests.items() if (name, s) in wanted}
        if requests:
            runs[name] = replace(run, requests=requests)
    cost = WeightedSum([problem.cost.terms[i] for i in channels])
    return replace(problem, picks=picks, runs=runs, cost=cost)


def name_of(effect: str, parameter: str) -> str:
    """Return the name that an effect's parameter has in a study."""
    return f"{effect}_{parameter}"


def strength_of(effect: str) -> tuple[str, Quantity]:
    """Return name and limits of the parameter that measures an effect."""
    ((name, quantity),) = known_effects()[effect].strength.items()
    return name, quantity


def fraction(quantity: Quantity, value: float) -> float:
    """Return a value as a fraction of the search range, within them."""
    share = (value - quantity.lower) / (quantity.upper - quantity.lower)
    return float(np.clip(share, 0.0, 1.0))


def extended(x: FloatArray, effect: str, strength: float, form: Sequence[str] = ()) -> FloatArray:
    """Return x with an effect's parameters behind it: its strength [SI], forms as usual."""
    quantities = known_effects()[effect].quantities
    added = [fraction(strength_of(effect)[1], strength)]
    added += [fraction(quantities[name], quantities[name].value) for name in form]
    return np.concatenate([x, added])
