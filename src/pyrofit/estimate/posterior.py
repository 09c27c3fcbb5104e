"""Statistics of an optimum: one covariance, one dispersion, one rule for limits.

Parameters are counted in distances of their limits, x in [0, 1]. Near its least value chi-square
is a parabola. With J = d whitened residuals / d x, of the channels and then of known values (K),

    C = (J_c^T J_c / s^2 + K^T K + 12 I)^-1,    s^2 = max(1, chi2_c / freedom).

Few repeats may hide lasting errors U, which do not weigh the points. With V the whitened U, of
unit covariance each, they add C J^T V V^T J C / s^4 to the covariance (the sandwich of generalised
least squares with other weights).

Limits count as known, too: a uniform distribution over them has the variance 1/12. Misfit beyond
the noise widens the noise of the channels by s, but not that of known values.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.constants import QUANTILE
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

UNIFORM = 12.0
"""Inverse variance of a value that is anywhere between its limits."""
AT_LIMIT = 0.005
"""A value this near to a limit, as a fraction of the search range, is at it."""


def limit_of(x: float) -> str:
    """Name the limit that a value in [0, 1] is at, if any.

    >>> limit_of(0.004), limit_of(0.5), limit_of(1.0)
    ('lower', '', 'upper')
    """
    return "lower" if x <= AT_LIMIT else "upper" if x >= 1.0 - AT_LIMIT else ""


def interval(x: float, sd: float, lower: float = 0.0, upper: float = 1.0) -> tuple[float, float]:
    """Return the ends of the linear 95 % interval x +- 1.96 sd, cut off at the limits.

    >>> interval(0.5, 0.1), interval(0.1, 0.1)[0]
    ((0.304, 0.696), 0.0)
    """
    return max(x - QUANTILE * sd, lower), min(x + QUANTILE * sd, upper)


def curvature(jacobian: FloatArray, dispersion: float = 1.0, known: int = 0) -> FloatArray:
    """Return the inverse covariance J_c^T J_c / s^2 + K^T K + 12 I, shape (parameters, parameters).

    Parameters
    ----------
    jacobian
        J, shape (rows, parameters).
    dispersion
        s^2, by which misfit raises the variance of the channels.
    known
        Number of rows of known values, which are the last ones.
    """
    rows = jacobian[len(jacobian) - known :]
    scaled = linear.gram(jacobian) / dispersion + (1.0 - 1.0 / dispersion) * linear.gram(rows)
    return np.asarray(scaled + UNIFORM * np.eye(jacobian.shape[1]))


def covariance(jacobian: FloatArray, dispersion: float = 1.0, known: int = 0) -> FloatArray:
    """Return the covariance, the inverse of `curvature`.

    Without data the limits remain, of variance 1/12:

    >>> covariance(np.zeros((5, 1)))
    array([[0.08333333]])
    """
    return linear.inverse(curvature(jacobian, dispersion, known))


def freedom(jacobian: FloatArray, x: FloatArray, known: int = 0) -> float:
    """Return the degrees of freedom of the channels: points less parameters that the data use up.

    n - trace(J_c (J^T J + 12 I)^-1 J_c^T), 1 at least. A parameter that limits or known values
    determine better than the data do uses up little; one at a limit does not move.

    >>> freedom(np.full((100, 1), 1e3), np.array([0.5])).__round__(3)
    99.0
    """
    inside = [not limit_of(value) for value in x]
    J = jacobian[:, inside]
    channels = J[: len(J) - known]
    used = linear.solve(curvature(J), linear.gram(channels))
    return max(1.0, len(channels) - float(np.trace(used)))


@dataclass(frozen=True, eq=False)
class Posterior:
    """Parameters about an optimum.

    Parameters
    ----------
    x
        Optimum, shape (parameters,).
    residuals
        Whitened residuals of the channels there, shape (points,).
    jacobian
        d residuals / d x of the channels, then of known values, shape (points + known,
        parameters).
    """

    x: FloatArray
    residuals: FloatArray
    jacobian: FloatArray
    hidden: FloatArray | None = None
    """V^T J of errors that few repeats may hide, shape (errors, parameters)."""

    @property
    def free_jacobian(self) -> FloatArray:
        """The Jacobian by the parameters that are not at a limit."""
        return np.asarray(self.jacobian[:, [not limit_of(value) for value in self.x]])

    @property
    def known(self) -> int:
        """Number of known values."""
        return len(self.jacobian) - self.residuals.size

    @property
    def chi2(self) -> float:
        """Chi-square of the channels, without known values."""
        return linear.dot(self.residuals, self.residuals)

    @property
    def freedom(self) -> float:
        """Degrees of freedom of the channels."""
        return freedom(self.jacobian, self.x, self.known)

    @property
    def dispersion(self) -> float:
        """s^2: chi-square per degree of freedom, 1 at least. An interval is wider by its root s."""
        return max(1.0, self.chi2 / self.freedom)

    def covariance(
        self, index: Sequence[int] | None = None, dispersion: float | None = None
    ) -> FloatArray:
        """Return C of some parameters, the others fixed; by default of all.

        The dispersion is by default the one that the residuals show.
        """
        J = self.jacobian if index is None else self.jacobian[:, list(index)]
        dispersion = self.dispersion if dispersion is None else dispersion
        C = covariance(J, dispersion, self.known)
        if self.hidden is None:
            return C
        hidden = self.hidden if index is None else self.hidden[:, list(index)]
        return np.asarray(C + linear.gram(linear.product(hidden, C)) / dispersion**2)

    def widening(self, index: Sequence[int]) -> FloatArray:
        """Return variances of some parameters over those without errors that repeats may hide."""
        if self.hidden is None:
            return np.ones(len(index))
        alone = covariance(self.jacobian[:, list(index)], self.dispersion, self.known)
        return np.asarray(np.diag(self.covariance(index)) / np.diag(alone))
