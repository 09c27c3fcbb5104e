"""A line as model, with its likelihood."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from pyrofit.cost import Target
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.derivatives import SECANT, Difference
from pyrofit.estimate.identify import Identification
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.solver.arrays import FloatArray, Status

N = 200


TIME = np.linspace(0.0, 1.0, N)


WHITE = np.random.default_rng(5).standard_normal(N)


@dataclass(frozen=True)
class Posed:
    """A problem of one channel: a formula in place of a simulation."""

    names: tuple[str, ...]
    lower: FloatArray
    upper: FloatArray
    formula: Any
    target: Target

    @property
    def difference(self) -> Difference:
        return SECANT

    @property
    def span(self) -> FloatArray:
        return self.upper - self.lower

    @property
    def moving(self) -> tuple[int, ...]:
        return tuple(range(len(self.names)))

    @property
    def idle(self) -> tuple[int, ...]:
        return ()

    @property
    def picks(self) -> list[tuple[str, str, None]]:
        return [("slab", "mlr", None)]

    @property
    def cost(self) -> Any:
        return SimpleNamespace(terms=[(1.0, SimpleNamespace(target=self.target))])

    @property
    def runs(self) -> Any:
        point = SimpleNamespace(
            quantity=lambda signal: SimpleNamespace(
                sampling="point", name="mlr", against_temperature=False, rests_on=()
            )
        )
        return {"slab": SimpleNamespace(experiment=point)}

    def values(self, x: FloatArray) -> dict[str, float]:
        return dict(zip(self.names, x.tolist(), strict=True))

    def temperature_K(self, channel: int) -> None:
        return None

    def simulate_all(
        self, X: FloatArray, led: bool = False
    ) -> list[tuple[Status, list[FloatArray]]]:
        curves = [self.formula(x) for x in X]
        return [(Status.DIVERGED, []) if c is None else (Status.OK, [c]) for c in curves]


def likelihood(formula: Any, value: FloatArray, sd: float, limits: Any) -> Likelihood:
    lower, upper = np.array(limits, dtype=float).T
    names = tuple("abc"[: lower.size])
    problem: Any = Posed(names, lower, upper, formula, Target(TIME, value))
    return Likelihood(problem, (NoiseModel(np.full(N, sd), Correlation()),))


LINE = np.column_stack([np.ones(N), TIME])


def line(sd: float = 0.1, limits: Any = ((0.0, 2.0), (0.0, 4.0))) -> Likelihood:
    """y = 1 + 2 t with white noise of unit variance times sd, scaled to chi2 = n - 2."""
    noise = WHITE - LINE @ np.linalg.lstsq(LINE, WHITE, rcond=None)[0]
    noise *= np.sqrt(N - 2) / np.linalg.norm(noise)
    return likelihood(lambda x: LINE @ x, LINE @ [1.0, 2.0] + sd * noise, sd, limits)


def by_name(found: Identification) -> dict[str, Any]:
    return {e.name: e for e in found.estimates}
