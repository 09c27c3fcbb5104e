"""A series as a smooth curve and correlated scatter.

y = X b + sd(t) e: X are cubic B-splines, e has unit variance and is correlated over few points. Its
correlation, and its size where none is stated, are those of the highest restricted likelihood
(Patterson and Thompson 1971, doi 10.1093/biomet/58.3.545). This allows for the noise that the curve
absorbs. The number of splines has the lowest BIC.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline
from scipy.optimize import minimize_scalar

from pyrofit.estimate.correlation import Correlation, shrunk
from pyrofit.estimate.restricted import LEAST_SQUARES, Restricted
from pyrofit.numerics import fitting, functions, linear
from pyrofit.solver.arrays import FloatArray

NEAR = 0.02
"""How nearly a correlation is found: a few hundred points tell it to 0.05 at best."""
LARGEST_AR = 0.9995
CLEAR = 10.0
"""Difference of BIC that is strong evidence (Kass and Raftery 1995, doi 10.2307/2291091)."""

_SPLINES = (4, 6, 8, 11, 15, 20, 27, 36, 48, 64)
_ENOUGH_SPLINES = 27
_MOST_SPLINES = 0.34
"""Most splines per point."""
_STEEP = 20
"""A curve that needs more evenly spaced splines is steep somewhere, and smooth elsewhere."""
_LASTS = 0.8
"""Correlation from point to point from which noise may be a curve that was not followed."""
_MUCH = 0.2
"""Difference of BIC per point that tells a curve from noise that lasts. Measured: 0.26 to 0.31 at
ignitions of three cone tests, 0.09 to 0.14 for noise of correlation 0.9^k at lag k."""
_DENSE_SPLINES = (8, 11, 15, 20, 27)
_WINDOW = 0.03
"""Window over which the slope is averaged that places dense knots, as a fraction of the record."""
_EVEN = 0.3
"""Share of the knots that are evenly spaced even so."""


@dataclass(frozen=True, eq=False)
class Scatter:
    """Curve and the scatter about it; the criterion is lowest for the best of several."""

    criterion: float
    correlation: Correlation
    scale: float
    curve: FloatArray
    scatter: FloatArray
    """Whitened, of unit variance, shape (n,)."""
    basis: FloatArray
    """Orthonormal basis of the whitened splines, shape (n, splines)."""

    @property
    def splines(self) -> int:
        """Number of splines of the curve."""
        return int(self.basis.shape[1])


def scatter_of(time: FloatArray, value: FloatArray, shape: FloatArray, known: bool) -> Scatter:
    """Return curve and scatter of a series, of the lowest criterion.

    From enough splines to follow any curve, more are tried while they lower it. Before that, few
    splines and lasting noise may look likelier than one more spline.

    Parameters
    ----------
    time, value
        The series, shape (n,).
    shape
        sd(t), or a curve proportional to it, shape (n,).
    known
        Whether ``shape`` is sd(t) itself.
    """
    best: Scatter | None = None
    worse = 0
    for splines in _SPLINES:
        if best is not None and splines > _MOST_SPLINES * shape.size:
            break
        if splines > _ENOUGH_SPLINES and worse > 1:
            break
        here = _likeliest(_basis(time, splines), value, shape, known)
        lower = best is None or here.criterion < best.criterion
        worse = 0 if lower else worse + 1
        best = here if worse == 0 else best
    assert best is not None
    # At a steep part, few splines and noise that lasts look likelier than many splines.
    if known or (best.splines <= _STEEP and best.correlation.ar < _LASTS):
        return best
    place = _dense_where_steep(time, value)
    few = [splines for splines in _DENSE_SPLINES if splines <= _MOST_SPLINES * shape.size]
    dense = [_likeliest(_basis(place, splines), value, shape, known) for splines in few]
    other = min(dense, key=lambda fit: fit.criterion, default=best)
    clear = CLEAR if best.splines > _STEEP else _MUCH * shape.size
    return other if other.criterion < best.criterion - clear else best


def _likeliest(X: FloatArray, value: FloatArray, shape: FloatArray, known: bool) -> Scatter:
    X, y = X / shape[:, None], value / shape
    fits = (_fit(X, y, shape, found, known) for found in _correlations(X, y, known))
    return min(fits, key=lambda fit: fit.criterion)


def _basis(at: FloatArray, splines: int) -> FloatArray:
    """Return cubic B-splines over a rising coordinate, shape (n, splines).

    Knots are evenly spaced. If points are missing between two of them, as in a gap of the record,
    equal numbers of points lie between knots instead.
    """
    inner = np.linspace(at[0], at[-1], splines - 2)
    if np.any(np.histogram(at, inner)[0] == 0):
        inner = np.interp(np.linspace(0, at.size - 1, splines - 2), np.arange(at.size), at)
    knots = np.concatenate([[at[0]] * 3, inner, [at[-1]] * 3])
    return np.asarray(BSpline.design_matrix(at, knots, 3).toarray(), dtype=np.float64)


def _dense_where_steep(time: FloatArray, value: FloatArray) -> FloatArray:
    """Return a coordinate that passes quickly where the series is steep, from 0 to 1, shape (n,).

    Its speed is an even part and one that grows as the root of the slope: splines evenly spaced
    over it are dense in a step or a peak, and few elsewhere.
    """
    n = time.size
    width = max(1, round(0.5 * _WINDOW * n))
    total = np.concatenate([[0.0], np.cumsum(value)])
    low = np.maximum(np.arange(n) - width, 0)
    high = np.minimum(np.arange(n) + width + 1, n)
    smooth = (total[high] - total[low]) / (high - low)
    steps = np.sqrt(np.abs(np.diff(smooth)) * np.diff(time))
    even = np.diff(time) / (time[-1] - time[0])
    speed = _EVEN * even + (1.0 - _EVEN) * steps / max(float(steps.sum()), 1e-300)
    return np.asarray(np.concatenate([[0.0], np.cumsum(speed)]) / speed.sum())


def _correlations(X: FloatArray, y: FloatArray, known: bool) -> list[Correlation]:
    """Return the likeliest correlation of each kind: none, one lag, two lags, lasting."""
    criterion = Restricted(X, y, known)

    def one(lag: float) -> float:
        return criterion(shrunk((lag,)))

    def two(lags: FloatArray) -> float:
        return criterion(shrunk(tuple(lags.tolist())))

    def lasting(size: float) -> float:
        return criterion(Correlation(ar=float(functions.tanh(size))))

    lag = minimize_scalar(one, bounds=(-0.5, 0.5), method="bounded", options={"xatol": NEAR}).x
    simplex = np.array([[lag, 0.0], [lag, -0.1], [0.0, 0.1]])
    lags = fitting.nelder_mead(two, simplex, near=NEAR, like=0.2)
    # Where its size is not known, noise as slow as the curve would be taken for the curve.
    slowest = LARGEST_AR if known else float(functions.exp(-3.0 * (X.shape[1] - 3) / len(y)))
    limits = (-1.5, math.atanh(slowest))
    ar = minimize_scalar(lasting, bounds=limits, method="bounded", options={"xatol": NEAR}).x
    return [
        Correlation(),
        shrunk((float(lag),)),
        shrunk(tuple(lags.tolist())),
        Correlation(ar=float(functions.tanh(ar))),
    ]


def _fit(
    X: FloatArray, y: FloatArray, shape: FloatArray, found: Correlation, known: bool
) -> Scatter:
    """Fit the curve, and judge it by BIC: -2 log likelihood + numbers fitted * log n.

    Splines that follow white noise leave neighbours that deviate to opposite sides. Taken for a
    property of the noise, this makes every lasting deviation look significant. Such a correlation
    therefore costs as much as strong evidence for it brings.
    """
    white = found.whiten(np.column_stack([X, y]))
    basis, R = linear.qr(white[:, :-1])
    part = linear.product(basis.T, white[:, -1])
    scatter = white[:, -1] - linear.product(basis, part)
    n, splines = X.shape
    squares = max(linear.dot(scatter, scatter), LEAST_SQUARES)
    scale = float(np.sqrt(squares / (n - splines)))
    misfit = squares if known else n * functions.log(squares / n)
    return Scatter(
        criterion=found.log_det(n)
        + misfit
        + (splines + found.numbers) * functions.log(n)
        + (CLEAR if found.opposed else 0.0),
        correlation=found,
        scale=scale,
        curve=shape * linear.product(X, linear.solve_upper(R, part)),
        scatter=scatter / scale,
        basis=basis,
    )
