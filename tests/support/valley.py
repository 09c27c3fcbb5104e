"""A problem whose cost has a valley."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from pyrofit.estimate.derivatives import PARABOLA
from pyrofit.estimate.problem import FAILED_COST, Evaluation
from pyrofit.solver.arrays import FloatArray, Status


@dataclass
class Valley:
    """|x - optimum| within limits, where ``fails`` says the model does not finish."""

    optimum: tuple[float, ...] = (0.3, -20.0)
    lower: FloatArray = field(default_factory=lambda: np.array([0.0, -50.0]))
    upper: FloatArray = field(default_factory=lambda: np.array([1.0, 10.0]))
    fails: Callable[[FloatArray], bool] = lambda x: False
    asked: list[FloatArray] = field(default_factory=list)

    difference = PARABOLA
    names = ("a", "b")
    picks = (("run", "signal", np.arange(2)),)

    def residuals(self, x: FloatArray) -> FloatArray:
        return (x - np.array(self.optimum)) / (self.upper - self.lower)

    def residuals_all(self, X: FloatArray, led: bool = False) -> list[FloatArray]:
        return [self.residuals(x) for x in X]

    def evaluate(self, x: FloatArray) -> Evaluation:
        self.asked.append(x.copy())
        if self.fails(x):
            return Evaluation(FAILED_COST, (FAILED_COST,), Status.TOO_MANY_STEPS)
        cost = float(np.linalg.norm(self.residuals(x)))
        return Evaluation(cost, (cost,), Status.OK)

    def evaluate_all(self, X: FloatArray) -> list[Evaluation]:
        return [self.evaluate(x) for x in X]
