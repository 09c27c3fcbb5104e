"""Noise of a record, and the discrepancy that a scheme leaves.

The covariance of a record's points, with T their temperatures and x their conversion, is

    C = scatter^2 I + drift^2 exp(-|T - T'|/L_d) + shift^2 m'(T) m'(T)^T
        + s^2 g g^T exp(-|T - T'|/L),    g = 2 sqrt(x (1 - x)).

The first three terms are the scatter of repeats in one laboratory. The last is the misfit beyond
them, which a wrong scheme has while the mass changes. Its size s is found by maximum likelihood
for each scheme, so that neither the number of points nor a fixed floor decides.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.noise import NoiseModel
from pyrofit.numerics import functions, linear
from pyrofit.scheme.records import MassRecord
from pyrofit.scheme.settings import SchemeSettings
from pyrofit.solver.arrays import FloatArray

LOG_2_PI = math.log(2.0 * math.pi)
LEAST = 0.05
"""Least g, so that no point is free of discrepancy."""


@dataclass(frozen=True, eq=False)
class RecordNoise(NoiseModel):
    """Noise of a whole covariance C: whitening is the product with ``inverse``, L^-1 of C = L L^T.

    ``inverse`` has the shape (n, n).
    """

    inverse: FloatArray = field(default_factory=lambda: np.eye(1))

    def whiten(self, residual: FloatArray) -> FloatArray:
        """Return L^-1 r of residuals, shape (n,) or (n, k)."""
        return np.asarray(linear.product(self.inverse, residual))


@dataclass(frozen=True, eq=False)
class RecordScatter:
    """Covariance of the points of a record; see the head of the module."""

    record: MassRecord
    settings: SchemeSettings

    @cached_property
    def _parts(self) -> tuple[FloatArray, FloatArray]:
        """Covariances of drift, and of a discrepancy of size 1, (n, n) each."""
        r, given = self.record, self.settings
        apart = np.abs(np.subtract.outer(r.temperature_K, r.temperature_K))
        drift = given.drift**2 * functions.exp(-apart / given.drift_length_K)
        g = np.maximum(2.0 * np.sqrt(r.converted * (1.0 - r.converted)), LEAST)
        return drift, np.outer(g, g) * functions.exp(-apart / given.discrepancy_length_K)

    def covariance(self, size: float) -> FloatArray:
        """Return C, shape (n, n)."""
        drift, unit = self._parts
        moved = self.settings.repeat_shift_K * self.record.slope
        lasting = drift + np.outer(moved, moved) + size**2 * unit
        return np.asarray(lasting + self.settings.scatter**2 * np.eye(self.record.mass.size))

    def noise(self, size: float) -> "RecordNoise":
        """Return the noise of a channel that has this covariance."""
        sd = np.full(self.record.mass.size, self.settings.scatter)
        return RecordNoise(sd, Correlation(), origin="repeats", inverse=self.factors[size][0])

    @cached_property
    def factors(self) -> dict[float, tuple[FloatArray, float]]:
        """Inverse Cholesky factor and log det of C, by size."""
        return {size: _factor(self.covariance(size)) for size in self.settings.discrepancies}


def deviance(
    scatters: Sequence[RecordScatter], residuals: Sequence[FloatArray], size: float
) -> float:
    """Return -2 log density of residuals, one array per record."""
    total = 0.0
    for scatter, r in zip(scatters, residuals, strict=True):
        inverse, log_det = scatter.factors[size]
        white = linear.product(inverse, r)
        total += linear.dot(white, white) + log_det + r.size * LOG_2_PI
    return total


def most_likely(scatters: Sequence[RecordScatter], residuals: Sequence[FloatArray]) -> float:
    """Return the size of the discrepancy, among those of the settings, of least deviance."""
    known = scatters[0].settings.discrepancies
    return min(known, key=lambda size: deviance(scatters, residuals, size))


def log_density_of_noise(residual: FloatArray, covariance: FloatArray) -> float:
    """Return the log density of a normal distribution at a residual, shapes (n,) and (n, n).

    >>> round(log_density_of_noise(np.zeros(1), np.eye(1)), 4)
    -0.9189
    """
    inverse, log_det = _factor(covariance)
    white = linear.product(inverse, residual)
    return -0.5 * (linear.dot(white, white) + log_det + residual.size * LOG_2_PI)


def _factor(covariance: FloatArray) -> tuple[FloatArray, float]:
    inverse = linear.inverse_root(covariance)
    return inverse, -2.0 * float(functions.log(np.diag(inverse)).sum())
