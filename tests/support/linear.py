"""Models that are linear in all parameters, so that every answer can be worked out by hand.

Two gasifications with two signals each, named like those of `small`; a curve is the sum of a
column times each parameter. Noise is white and of unit variance. The base has the parameters
rho and k from -10 to 10; effects of the catalogue have columns of the test's own.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from small import CHANNELS, base_of, study

from pyrofit.cost import Target, WeightedSum, make_term
from pyrofit.diagnose.base.descent import descend_chi_square, refreshed
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Base, Model, model_of, name_of, strength_of
from pyrofit.diagnose.settings import Settings
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.prior import NO_PRIOR, NormalPrior
from pyrofit.estimate.problem import Outcome, Problem
from pyrofit.solver.arrays import FloatArray, Status

POINTS = 50
TOTAL = POINTS * len(CHANNELS)
TIME = np.arange(POINTS, dtype=float)
NAMES = ("rho", "k")
SPAN = 20.0
Columns = Mapping[str, FloatArray]
"""By parameter, what one unit of it adds to all channels, shape (TOTAL,)."""


@dataclass(frozen=True)
class Linear(Problem):
    """A problem whose curves are sums of columns."""

    columns: Columns

    @cached_property
    def moving(self) -> tuple[int, ...]:
        """Positions of the parameters that change a picked channel."""
        parts = {name: np.split(column, len(CHANNELS)) for name, column in self.columns.items()}
        picked = [CHANNELS.index((name, signal)) for name, signal, _ in self.picks]
        return tuple(
            i
            for i, name in enumerate(self.names)
            if any(np.any(parts[name][k]) for k in picked if name in parts)
        )

    def simulate_all(self, X: FloatArray, led: bool = False) -> list[Outcome]:
        """Return the curves of the channels."""
        return [self._simulated_one(x) for x in X]

    def _simulated_one(self, x: FloatArray) -> Outcome:
        total = np.zeros(TOTAL)
        for name, value in zip(self.names, x.tolist(), strict=True):
            total = total + value * self.columns.get(name, 0.0)
        parts = dict(zip(CHANNELS, np.split(total, len(CHANNELS)), strict=True))
        return Status.OK, [parts[name, signal] for name, signal, _ in self.picks]


def random_columns(seed: int, *effects: str, size: float = 10.0) -> dict[str, FloatArray]:
    """Return columns of the base's parameters, and of effects at typical strength, all smooth.

    The norm of each is ``size`` for a typical strength, or for a parameter's unit.
    """
    rng = np.random.default_rng(seed)
    wave = np.sin(np.outer(np.arange(1, 9), np.linspace(0.0, np.pi, POINTS)))
    columns = {}
    for name in (*NAMES, *effects):
        column = (rng.standard_normal((len(CHANNELS), 8)) @ wave).ravel()
        typical = 1.0 if name in NAMES else strength_of(name)[1].typical
        key = name if name in NAMES else strength_name(name)
        columns[key] = column * size / np.linalg.norm(column) / typical
    return columns


def strength_name(effect: str) -> str:
    return name_of(effect, strength_of(effect)[0])


def base(
    columns: Columns,
    y: FloatArray,
    calibrated: tuple[int, ...] = (0, 1, 2, 3),
    known: NormalPrior = NO_PRIOR,
    settings: Settings = Settings(),
) -> Base:
    """Return the base of these columns, measured y, shape (TOTAL,)."""
    usual = base_of(study()).likelihood.problem
    terms = [(1.0, make_term("RMSE", Target(TIME, part))) for part in np.split(y, len(CHANNELS))]
    problem = Linear(
        names=NAMES,
        lower=np.full(len(NAMES), -0.5 * SPAN),
        upper=np.full(len(NAMES), 0.5 * SPAN),
        material=usual.material,
        fixed={},
        runs=usual.runs,
        picks=tuple((name, signal, np.arange(POINTS)) for name, signal, _ in usual.picks),
        cost=WeightedSum(terms),
        accuracy=usual.accuracy,
        columns=columns,
    )
    # Known exactly: no estimate explains more.
    white = NoiseModel(np.ones(POINTS), Correlation(), criterion=-np.inf)
    likelihood = Likelihood(problem, (white,) * len(CHANNELS), known)
    return Base(likelihood, calibrated, settings=settings)


def fitted(model: Model) -> FittedModel:
    return FittedModel(
        model, refreshed(model, descend_chi_square(model, np.full(len(model.names), 0.45)))
    )


def fit(columns: Columns, y: FloatArray, **options: object) -> FittedModel:
    """Return the fit of the base."""
    return fitted(model_of(base(columns, y, **options), {}))  # type: ignore[arg-type]


def fit_with(trial: FittedModel, *effects: str) -> FittedModel:
    """Return the fit of a base with effects."""
    free = {effect: (strength_of(effect)[0],) for effect in effects}
    return fitted(model_of(trial.model.base, free, trial.model.channels))


def fraction_columns(columns: Columns, model: Model) -> FloatArray:
    """Return d curves / d x of the calibrated channels, x in fractions of the search range."""
    problem = model.likelihood.problem
    span = problem.upper - problem.lower
    every = np.column_stack([columns[name] for name in problem.names]) * span
    rows = np.arange(TOTAL).reshape(len(CHANNELS), POINTS)[list(model.channels)].ravel()
    return every[rows]


def moved(trial: FittedModel, **changes: object) -> FittedModel:
    return replace(trial, fit=replace(trial.fit, **changes))  # type: ignore[arg-type]


def column_of(columns: Columns, effect: str) -> FloatArray:
    return columns[strength_name(effect)]
