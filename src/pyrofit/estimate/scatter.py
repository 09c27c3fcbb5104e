"""A series as a smooth curve and correlated scatter.

y = X b + sd(t) e: X are cubic B-splines, e has unit variance and is correlated over few points. Its
correlation, and its size where none is stated, are those of the highest restricted likelihood
(Patterson and Thompson 1971, doi 10.1093/biomet/58.3.545). This allows for the noise that the curve
absorbs. The number of splines has the lowest BIC. It needs log det R and the least sum of squares
alone: no curve is fitted but the last one.
"""

import math
from collections.abc import Callable
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
_SURE = 10.0
"""Difference from a bound of BIC that its search may miss."""
_FEW_POINTS = 100
"""Points up to which lags are searched as fast as their bound."""

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
    # Each of several is only judged, and the best one fitted.
    best: _Judged | None = None
    worse = 0
    for splines in _SPLINES:
        if best is not None and splines > _MOST_SPLINES * shape.size:
            break
        if splines > _ENOUGH_SPLINES and worse > 1:
            break
        here = _likeliest(_basis(time, splines), value, shape, known, best)
        lower = best is None or here.criterion < best.criterion
        worse = 0 if lower else worse + 1
        best = here if worse == 0 else best
    assert best is not None
    # At a steep part, few splines and noise that lasts look likelier than many splines.
    if not known and (best.splines > _STEEP or best.correlation.ar >= _LASTS):
        clear = CLEAR if best.splines > _STEEP else _MUCH * shape.size
        other = _best_of_dense(time, value, shape)
        if other is not None and other.criterion < best.criterion - clear:
            best = other
    return _fit(best.X, value / shape, shape, best.correlation, known)


@dataclass(frozen=True, eq=False)
class _Judged:
    """Splines over the size of the noise, shape (n, splines), their likeliest noise and its BIC."""

    criterion: float
    correlation: Correlation
    X: FloatArray

    @property
    def splines(self) -> int:
        return int(self.X.shape[1])


def _best_of_dense(time: FloatArray, value: FloatArray, shape: FloatArray) -> _Judged | None:
    """Return the best of splines that are dense where a series is steep, if it has the points."""
    place = _dense_where_steep(time, value)
    best: _Judged | None = None
    for splines in _DENSE_SPLINES:
        if splines <= _MOST_SPLINES * shape.size:
            here = _likeliest(_basis(place, splines), value, shape, False, best)
            best = here if best is None or here.criterion < best.criterion else best
    return best


def _likeliest(
    X: FloatArray, value: FloatArray, shape: FloatArray, known: bool, best: _Judged | None
) -> _Judged:
    """Return the likeliest of all kinds of noise: none, lasting, one lag, two lags.

    Lags are left out where their bound shows that they are not the best of these and of another.
    """
    X, y = X / shape[:, None], value / shape
    likelihood = Restricted(X, y, known)
    found = [_judged(X, likelihood, kind) for kind in (Correlation(), _lasting(X, likelihood))]
    least = min(fit.criterion for fit in (*found, best) if fit is not None)
    if y.size <= _FEW_POINTS or _bound_of_lags(X, likelihood) < least + _SURE:
        found[1:1] = [_judged(X, likelihood, kind) for kind in _lags(likelihood)]
    return min(found, key=lambda fit: fit.criterion)


def _judged(X: FloatArray, likelihood: Restricted, found: Correlation) -> _Judged:
    log_det, _, squares = likelihood.parts(found)
    return _Judged(_bic(log_det, squares, X, found, likelihood.known), found, X)


def _bic(log_det: float, squares: float, X: FloatArray, found: Correlation, known: bool) -> float:
    """Return -2 log likelihood + numbers fitted * log n.

    Splines that follow white noise leave neighbours that deviate to opposite sides. Taken for a
    property of the noise, this makes every lasting deviation look significant. Such a correlation
    therefore costs as much as strong evidence for it brings.
    """
    n, splines = X.shape
    misfit = squares if known else n * float(functions.log(squares / n))
    opposed = CLEAR if found.opposed else 0.0
    return float(log_det + misfit + (splines + found.numbers) * functions.log(n) + opposed)


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


def _lasting(X: FloatArray, likelihood: Restricted) -> Correlation:
    """Return the likeliest noise of correlation ar^k at lag k."""

    def criterion(size: float) -> float:
        return likelihood(Correlation(ar=float(functions.tanh(size))))

    # Where its size is not known, noise as slow as the curve would be taken for the curve.
    n, splines = X.shape
    slowest = LARGEST_AR if likelihood.known else float(functions.exp(-3.0 * (splines - 3) / n))
    limits = (-1.5, math.atanh(slowest))
    ar = minimize_scalar(criterion, bounds=limits, method="bounded", options={"xatol": NEAR}).x
    return Correlation(ar=float(functions.tanh(ar)))


def _lags(likelihood: Restricted) -> list[Correlation]:
    """Return the likeliest noise of one lag and of two."""

    def one(lag: float) -> float:
        return likelihood(shrunk((lag,)))

    lag = float(
        minimize_scalar(one, bounds=(-0.5, 0.5), method="bounded", options={"xatol": NEAR}).x
    )
    return [shrunk((lag,)), _of_two_lags(likelihood, lag)]


def _of_two_lags(criterion: Callable[[Correlation], float], lag: float) -> Correlation:
    """Return the noise of two lags of the least criterion, from a start with one."""

    def two(lags: FloatArray) -> float:
        return criterion(shrunk(tuple(lags.tolist())))

    simplex = np.array([[lag, 0.0], [lag, -0.1], [0.0, 0.1]])
    lags = fitting.nelder_mead(two, simplex, near=NEAR, like=0.2)
    return shrunk(tuple(lags.tolist()))


def _bound_of_lags(X: FloatArray, likelihood: Restricted) -> float:
    """Return a number that the BIC of one and of two lags is not below, but for the search."""
    n, splines = X.shape
    found = _of_two_lags(likelihood.bound, 0.2)
    return float(likelihood.bound(found) + (splines + 1) * functions.log(n))


def _fit(
    X: FloatArray, y: FloatArray, shape: FloatArray, found: Correlation, known: bool
) -> Scatter:
    """Fit the curve for one correlation of the noise."""
    white = found.whiten(np.column_stack([X, y]))
    basis, R = linear.qr(white[:, :-1])
    part = linear.product(basis.T, white[:, -1])
    scatter = white[:, -1] - linear.product(basis, part)
    n, splines = X.shape
    squares = max(linear.dot(scatter, scatter), LEAST_SQUARES)
    scale = float(np.sqrt(squares / (n - splines)))
    return Scatter(
        criterion=_bic(found.log_det(n), squares, X, found, known),
        correlation=found,
        scale=scale,
        curve=shape * linear.product(X, linear.solve_upper(R, part)),
        scatter=scatter / scale,
        basis=basis,
    )
