"""Correlation of noise from point to point: its form, its removal, and a test of the rest."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from pyrofit.data.noise import autoregressive, lowest_density, moving_average
from pyrofit.numerics import bands, functions, linear
from pyrofit.solver.arrays import FloatArray

LOWEST_DENSITY = 0.1
"""Least spectral density, relative to white noise. A series tells little of noise as slow as its
own curve; with a density near 0 that curve would count as known exactly."""
LAGS = 10
"""Lags of the Ljung-Box test."""
DRAWS = 200
"""Draws of white noise that give the distribution of its statistic."""


@dataclass(frozen=True)
class Correlation:
    """Autocorrelation of stationary noise by point: a few lags, or ar^k at lag k."""

    lags: tuple[float, ...] = ()
    ar: float = 0.0

    @property
    def numbers(self) -> int:
        """How many numbers describe it."""
        return len(self.lags) + (self.ar != 0.0)

    @property
    def opposed(self) -> bool:
        """Whether neighbours deviate to opposite sides rather than to the same."""
        return self.ar + sum(self.lags) < 0.0

    def sequence(self, points: int) -> FloatArray:
        """Return the autocorrelation at lags 0 ... points - 1."""
        if self.ar:
            return autoregressive(self.ar, points)
        return moving_average(self.lags, points)

    def whiten(self, noise: FloatArray) -> FloatArray:
        """Return L^-1 e of the correlation matrix R = L L^T; e is (n,) or (n, k)."""
        if self.ar:
            white = noise.copy()
            white[1:] -= self.ar * noise[:-1]
            white[1:] /= np.sqrt(1.0 - self.ar**2)
            return white
        if not self.lags:
            return noise
        return bands.solve_lower(_factor(self.lags, len(noise)), noise)

    def product(self, x: FloatArray) -> FloatArray:
        """Return R x; x is (n, k).

        >>> Correlation(ar=0.5).product(np.eye(3)[:, :1])[:, 0].tolist()
        [1.0, 0.5, 0.25]
        """
        found = x.copy()
        if self.ar:
            # Sums from both ends, a^|i-j| each; both have the point itself.
            backward = x.copy()
            for i in range(1, len(x)):
                found[i] += self.ar * found[i - 1]
                backward[-i - 1] += self.ar * backward[-i]
            return np.asarray(found + backward - x)
        for lag, r in enumerate(self.lags, start=1):
            found[lag:] += r * x[:-lag]
            found[:-lag] += r * x[lag:]
        return found

    def log_det(self, points: int) -> float:
        """Return log det R."""
        if self.ar:
            return 2.0 * (points - 1) * float(functions.log(np.sqrt(1.0 - self.ar**2)))
        if not self.lags:
            return 0.0
        return 2.0 * float(functions.log(_factor(self.lags, points)[:, 0]).sum())

    def describe(self) -> str:
        """Describe it in words.

        >>> Correlation(lags=(-0.25, -0.2)).describe()
        'correlation -0.25, -0.20 at lag 1, 2'
        """
        if self.ar:
            return f"correlation {self.ar:.3g}^k at lag k"
        if not self.lags:
            return "uncorrelated"
        at = ", ".join(str(k + 1) for k in range(len(self.lags)))
        return f"correlation {', '.join(f'{r:.2f}' for r in self.lags)} at lag {at}"


@lru_cache(maxsize=64)
def _factor(lags: tuple[float, ...], n: int) -> FloatArray:
    """Return the bands of L of R = L L^T, shape (n, lags + 1)."""
    return bands.cholesky(lags, n)


def shrunk(lags: tuple[float, ...]) -> Correlation:
    """Return lags times the factor that brings the spectral density up to its least value.

    >>> [round(r, 3) for r in shrunk((-0.12, -0.40)).lags]
    [-0.104, -0.346]
    """
    lowest = lowest_density(lags)
    factor = min(1.0, (1.0 - LOWEST_DENSITY) / (1.0 - lowest)) if lowest < 1.0 else 1.0
    return Correlation(lags=tuple(factor * r for r in lags))


def ljung_box(series: FloatArray) -> float:
    """Return Q = n (n + 2) sum_k r_k^2 / (n - k) over lags k = 1 ... 10, r about zero.

    >>> round(ljung_box(np.array([1.0, -1.0] * 10)), 6)  # r_k = (-1)^k (20 - k)/20
    159.5
    """
    n = series.size
    lags = np.arange(1, min(LAGS, n - 2) + 1)
    square = max(linear.dot(series, series), 1e-300)
    r = np.array([linear.dot(series[k:], series[:-k]) for k in lags]) / square
    return float(n * (n + 2) * np.sum(r**2 / (n - lags)))


def whiteness(scatter: FloatArray, basis: FloatArray) -> float:
    """Return the probability that white noise looks as correlated as a scatter.

    The Ljung-Box statistic (1978, doi 10.1093/biomet/65.2.297) is compared to that of drawn white
    noise less its own curve, which correlates it too.

    Parameters
    ----------
    scatter
        Whitened scatter about a curve, shape (n,).
    basis
        Orthonormal basis of the whitened curves, shape (n, k).
    """
    rng = np.random.default_rng(0)
    white = rng.standard_normal((scatter.size, DRAWS))
    white -= linear.product(basis, linear.product(basis.T, white))
    drawn = np.array([ljung_box(column) for column in white.T])
    return float((1 + np.sum(drawn >= ljung_box(scatter))) / (1 + DRAWS))
