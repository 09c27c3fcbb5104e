"""Stiff ordinary differential equations by numerical differentiation formulas of orders 1 to 5.

Steps of nearly constant size in the form of backward differences: Shampine and Reichelt (1997,
doi 10.1137/S1064827594276424). The control of step and order is that of SciPy's ``BDF``. The error
is the largest of all unknowns. No operation depends on the processor, as those of LAPACK do.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

MOST_ORDER = 5
_NEWTON = 4
"""Iterations of Newton's method at most."""
_SMALLER, _LARGER = 0.2, 10.0
"""Limits of a change of the step."""
_KAPPA = np.array([0.0, -0.1850, -1.0 / 9.0, -0.0823, -0.0415, 0.0])
_GAMMA = np.concatenate([[0.0], np.cumsum(1.0 / np.arange(1, MOST_ORDER + 1))])
_ALPHA = (1.0 - _KAPPA) * _GAMMA
_ERROR = _KAPPA * _GAMMA + 1.0 / np.arange(1, MOST_ORDER + 2)

Solve = Callable[[FloatArray], FloatArray]


class ReferenceBdf:
    """An integration from t to the end; `step` makes a step.

    Parameters
    ----------
    derivative
        From t and y, shape (n,), to dy/dt.
    t, y, end
        Where it begins, the state there, and where it ends.
    relative, absolute
        Tolerances of a step, relative to |y| and absolute, the latter of shape (n,).
    jacobian
        From t and y to d(dy/dt)/dy, in a form that ``factor`` knows.
    factor
        From that and c to a function that solves (I - c J) x = b.
    """

    def __init__(
        self,
        derivative: Callable[[float, FloatArray], FloatArray],
        t: float,
        y: FloatArray,
        end: float,
        relative: float,
        absolute: FloatArray | float,
        jacobian: Callable[[float, FloatArray], Any],
        factor: Callable[[Any, float], Solve],
    ) -> None:
        self._derivative, self._jacobian, self._factor = derivative, jacobian, factor
        self.t, self.y, self.end = float(t), np.array(y), float(end)
        self._relative, self._absolute = relative, absolute
        self._newton = max(2e-15 / relative, min(0.03, math.sqrt(relative)))
        self.status = "running" if self.t < self.end else "finished"
        slope = derivative(self.t, self.y)
        self._step = self._first_step(slope)
        self._size = self._step
        """Step of the differences."""
        self._order, self._equal = 1, 0
        self._differences = np.zeros((MOST_ORDER + 3, self.y.size))
        self._differences[0], self._differences[1] = self.y, slope * self._step
        self._J = jacobian(self.t, self.y)
        self._solve: Solve | None = None

    def _norm(self, error: FloatArray, y: FloatArray) -> float:
        return float(np.max(np.abs(error) / (self._absolute + self._relative * np.abs(y))))

    def _first_step(self, slope: FloatArray) -> float:
        """Return a step of the right order (Hairer, Norsett and Wanner 1993, section II.4)."""
        whole = self.end - self.t
        size, speed = self._norm(self.y, self.y), self._norm(slope, self.y)
        first = min(1e-6 if size < 1e-5 or speed < 1e-5 else 0.01 * size / speed, whole)
        ahead = self._derivative(self.t + first, self.y + first * slope)
        bent = self._norm(ahead - slope, self.y) / first if first > 0.0 else 0.0
        most = max(speed, bent)
        second = max(1e-6, 1e-3 * first) if most <= 1e-15 else math.sqrt(0.01 / most)
        return min(100.0 * first, second, whole)

    def step(self) -> None:
        """Make a step; the status tells whether that was the last one, or failed."""
        found = None
        least = 10.0 * (math.nextafter(self.t, math.inf) - self.t)
        self._resize(max(1.0, least / self._step))
        fresh = False
        while found is None:
            if self._step < least or not math.isfinite(self._step):
                self.status = "failed"
                return
            if self.t + self._step > self.end:
                self._resize((self.end - self.t) / self._step)
            ends = self.t + self._step >= self.end
            t = self.end if ends else self.t + self._step
            converged, turns, y, last = self._corrected(t)
            if not converged and not fresh:
                self._J, fresh, self._solve = self._jacobian(t, self._predicted()), True, None
            elif not converged:
                self._resize(0.5)
            else:
                safety = 0.9 * (2 * _NEWTON + 1) / (2 * _NEWTON + turns)
                error = self._norm(_ERROR[self._order] * last, y)
                if error > 1.0:
                    wanted = safety * error ** (-1.0 / (self._order + 1))
                    self._resize(max(_SMALLER, wanted), keep=True)
                else:
                    found = last
        self.t, self.y, self._size = t, y, self._step
        self._accept(found, error, safety)
        self.status = "finished" if ends else "running"

    def _predicted(self) -> FloatArray:
        return np.asarray(np.sum(self._differences[: self._order + 1], axis=0))

    def _corrected(self, t: float) -> tuple[bool, int, FloatArray, FloatArray]:
        """Return whether Newton's method converged, its turns, y and y less the predicted one."""
        order = self._order
        start = self._predicted()
        psi = linear.product(_GAMMA[1 : order + 1], self._differences[1 : order + 1])
        psi /= _ALPHA[order]
        c = self._step / float(_ALPHA[order])
        if self._solve is None:
            self._solve = self._factor(self._J, c)
        y, last, before = start.copy(), np.zeros(start.size), None
        for turn in range(_NEWTON):
            slope = self._derivative(t, y)
            if not np.isfinite(slope).all():
                break
            change = self._solve(c * slope - psi - last)
            size = self._norm(change, start)
            rate = None if before is None else size / before
            if not math.isfinite(size) or (rate is not None and self._hopeless(rate, size, turn)):
                break
            y, last, before = y + change, last + change, size
            if size == 0.0 or (rate is not None and rate / (1.0 - rate) * size < self._newton):
                return True, turn + 1, y, last
        return False, _NEWTON, y, last

    def _hopeless(self, rate: float, size: float, turn: int) -> bool:
        return bool(rate >= 1.0 or rate ** (_NEWTON - turn) / (1.0 - rate) * size > self._newton)

    def _resize(self, factor: float, keep: bool = False) -> None:
        """Change the step, and the differences with it; ``keep`` the factors of Newton's method."""
        if factor == 1.0:
            return
        order = self._order
        both = linear.product(_passage(order, factor), _passage(order, 1.0))
        self._differences[: order + 1] = linear.product(both.T, self._differences[: order + 1])
        self._step *= factor
        self._equal = 0
        if not keep:
            self._solve = None

    def _accept(self, last: FloatArray, error: float, safety: float) -> None:
        """Take a step in: new differences, and at times another order and step."""
        order, D = self._order, self._differences
        D[order + 2] = last - D[order + 1]
        D[order + 1] = last
        for i in reversed(range(order + 1)):
            D[i] += D[i + 1]
        self._dense = self._size, order, D[: order + 1].copy(), self.t
        self._equal += 1
        if self._equal < order + 1:
            return
        below = self._norm(_ERROR[order - 1] * D[order], self.y) if order > 1 else math.inf
        above = math.inf
        if order < MOST_ORDER:
            above = self._norm(_ERROR[order + 1] * D[order + 2], self.y)
        factors = [
            math.inf if e == 0.0 else e ** (-1.0 / (order + k))
            for k, e in enumerate((below, error, above))
        ]
        best = factors.index(max(factors))
        self._order = order + best - 1
        self._resize(min(_LARGER, safety * factors[best]))

    def dense_output(self) -> Callable[[FloatArray], FloatArray]:
        """Return the polynomial of the last step: from times to states, shape (n, times)."""
        h, order, D, t = self._dense

        def inside(times: FloatArray) -> FloatArray:
            k = np.arange(order)[:, None]
            share = (times - (t - h * k)) / (h * (1 + k))
            return np.asarray(D[0][:, None] + linear.product(D[1:].T, np.cumprod(share, axis=0)))

        return inside


def _passage(order: int, factor: float) -> FloatArray:
    """Return the matrix from differences to those of ``factor`` times the step."""
    i, j = np.arange(1, order + 1)[:, None], np.arange(1, order + 1)
    matrix = np.zeros((order + 1, order + 1))
    matrix[1:, 1:] = (i - 1 - factor * j) / i
    matrix[0] = 1.0
    return np.asarray(np.cumprod(matrix, axis=0), dtype=np.float64)
