"""The noise of a measured series, estimated from the series itself.

A series is a smooth curve and noise, y = X b + sd(t) e: X are cubic B-splines, e has unit variance
and is correlated over few points. Its correlation, and its size where none is stated, are those of
the highest restricted likelihood (Patterson and Thompson 1971, doi 10.1093/biomet/58.3.545), which
allows for what the curve takes away from the noise; the number of splines has the lowest BIC.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import BSpline
from scipy.optimize import minimize, minimize_scalar

from pyrofit.cost import Target
from pyrofit.errors import DataError
from pyrofit.estimate.correlation import Correlation, shrunk, whiteness
from pyrofit.solver.arrays import FloatArray

TIMING_S = 0.5
"""Error of the clocks [s]: a tenth of the usual 5-s bins. It counts where the curve is steep."""
SOLVER_ERROR = 1e-3
"""Error of a simulated curve as a fraction of the largest rise of the series: at default settings
the mass loss rate is off by 0.02 to 0.2 % of its mean."""
DISCREPANCY = {"mass_fraction": 0.02}
"""Least noise of a series without a stated uncertainty. TGA scatters by 5e-4 about its curve, but
models of several heating rates come no nearer than 0.02: it would outweigh all else."""
LASTING = 0.1
"""Time over which such a discrepancy lasts, as a fraction of the record: it is no noise of points,
and counts alike however many points are measured."""
SMOOTHING = 0.1
"""Window over which a stated uncertainty is smoothed, as a fraction of the record."""
LARGEST_AR = 0.9995
LEAST_SQUARES = 1e-30
"""Sum of squares at least; a series may lie on its curve exactly."""
FEWEST_POINTS = 8
UNITS = {"mlr": "kg/(m² s)", "back_temperature": "K", "mass_fraction": "-"}

_SPLINES = (4, 6, 8, 11, 15, 20, 27, 36, 48, 64)
_ENOUGH_SPLINES = 27
_MOST_SPLINES = 0.34
"""Most splines per point."""


@dataclass(frozen=True, eq=False)
class NoiseModel:
    """Noise of one measured series.

    Parameters
    ----------
    sd
        Standard deviation, floors included, shape (n,), in the unit of the series.
    correlation
        By point.
    splines
        Number of splines of the curve it scatters about.
    excess
        Scatter about that curve over what is stated, 1 where it is not significantly larger.
    whiteness
        Probability that white noise looks as correlated as the whitened scatter (Ljung-Box).
    origin
        Where the standard deviation comes from, in words.
    unit
        Unit of the series.
    floors
        Median of what is added to the standard deviation in squares, by name.
    """

    sd: FloatArray
    correlation: Correlation
    splines: int = 0
    excess: float = 1.0
    whiteness: float = 1.0
    origin: str = "given"
    unit: str = "-"
    floors: Mapping[str, float] = field(default_factory=dict)

    def whiten(self, residual: FloatArray) -> FloatArray:
        """Return w = L^-1 (r / sd): white and of unit variance if the residual is this noise.

        Parameters
        ----------
        residual
            r, shape (n,) or (n, k), in the unit of the series.
        """
        sd = self.sd if residual.ndim == 1 else self.sd[:, None]
        return self.correlation.whiten(residual / sd)[0]

    def describe(self) -> str:
        """Say its size, where that comes from, its correlation, and whether it whitens."""
        more = f"; the scatter is {self.excess:.2g} times that" if self.excess > 1.0 else ""
        floors = ", ".join(f"{name} {size:.2g}" for name, size in self.floors.items())
        test = "white" if self.whiteness >= 0.05 else "not white"
        return (
            f"sd {np.median(self.sd):.2g} {self.unit} ({self.origin}{more}; with {floors}; medians)"
            f", {self.correlation.describe()}; whitened: {test} (p = {self.whiteness:.2g})"
        )


def estimate_noise(target: Target, quantity: str, stated_sds: float = 1.0) -> NoiseModel:
    """Estimate size and correlation of the noise of a measured series.

    Parameters
    ----------
    target
        The series. A stated standard deviation counts in full: where points scatter less about a
        smooth curve, the rest is taken to vary slowly.
    quantity
        ``mlr``, ``back_temperature`` or ``mass_fraction``.
    stated_sds
        Standard deviations that the stated uncertainty stands for.

    Raises
    ------
    DataError
        The series has fewer than 8 points and no stated uncertainty.
    """
    count = target.value.size
    stated = smoothed(target)
    stated = None if stated is None else stated / stated_sds
    if count < FEWEST_POINTS:
        return _of_few_points(stated, count, quantity)
    shape = np.ones(count) if stated is None else stated
    fit = _best_fit(target, shape, stated is not None)
    larger = fit.scale > 1.0 + np.sqrt(2.0 / (count - fit.splines))
    scale = fit.scale if stated is None or larger else 1.0
    floors = _floors(target, fit.curve, quantity, stated is not None)
    correlation = fit.correlation
    origin = "from the scatter" if stated is None else "stated, smoothed over 10 % of the record"
    if "discrepancy" in floors:
        correlation = Correlation(ar=float(np.exp(-1.0 / (LASTING * (count - 1)))))
        origin = "discrepancy of models, lasting over 10 % of the record"
    squares = (scale * shape) ** 2 + sum(floor**2 for floor in floors.values())
    return NoiseModel(
        sd=np.sqrt(squares),
        correlation=correlation,
        splines=fit.splines,
        excess=1.0 if stated is None else scale,
        whiteness=whiteness(fit.scatter, fit.basis),
        origin=origin,
        unit=UNITS[quantity],
        floors={name: float(np.median(floor)) for name, floor in floors.items()},
    )


def _of_few_points(stated: FloatArray | None, count: int, quantity: str) -> NoiseModel:
    if stated is None:
        raise DataError(
            f"{quantity}: {count} points tell nothing of their noise, at least {FEWEST_POINTS} do; "
            "give an uncertainty, or leave the signal out of imp.identification"
        )
    return NoiseModel(stated, Correlation(), origin="stated", unit=UNITS[quantity])


def smoothed(target: Target) -> FloatArray | None:
    """Return the stated uncertainty smoothed over time, None where none is stated.

    The logarithm is averaged with a Gaussian window and the local mean square restored: an
    uncertainty from two repeats jumps from point to point and means no more than its neighbours'.
    """
    given = target.uncertainty
    if given is None or not np.any(given > 0.0):
        return None
    safe = np.maximum(given, 1e-3 * np.max(given))
    width = 0.25 * SMOOTHING * (target.time_s[-1] - target.time_s[0])
    window = np.exp(-0.5 * (np.subtract.outer(target.time_s, target.time_s) / width) ** 2)
    window /= window.sum(axis=1, keepdims=True)
    shape = np.exp(window @ np.log(safe))
    return np.asarray(shape * np.sqrt(window @ (safe / shape) ** 2), dtype=np.float64)


def _floors(
    target: Target, curve: FloatArray, quantity: str, stated: bool
) -> dict[str, FloatArray]:
    """Return what is added to the standard deviation, shape (n,) each."""
    slope = np.abs(np.gradient(curve, target.time_s))
    floors = {
        "timing": TIMING_S * slope,
        "solver": np.full(curve.size, SOLVER_ERROR * np.ptp(curve)),
    }
    if quantity in DISCREPANCY and not stated:
        floors["discrepancy"] = np.full(curve.size, DISCREPANCY[quantity])
    return floors


@dataclass(frozen=True, eq=False)
class _Fit:
    """Curve, correlation and scale; the criterion is lowest for the best of several."""

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
        return int(self.basis.shape[1])


def _best_fit(target: Target, shape: FloatArray, known: bool) -> _Fit:
    """Return the fit of the lowest criterion.

    From enough splines to follow any curve, more are tried while they lower it. Before that, few
    splines and lasting noise may look likelier than one more spline.
    """
    best: _Fit | None = None
    worse = 0
    for splines in _SPLINES:
        if best is not None and splines > _MOST_SPLINES * shape.size:
            break
        if splines > _ENOUGH_SPLINES and worse > 1:
            break
        X = _basis(target.time_s, splines) / shape[:, None]
        y = target.value / shape
        here = min(
            (_fit(X, y, shape, found, known) for found in _correlations(X, y, known)),
            key=lambda fit: fit.criterion,
        )
        worse = 0 if best is None or here.criterion < best.criterion else worse + 1
        best = here if worse == 0 else best
    assert best is not None
    return best


def _basis(time: FloatArray, splines: int) -> FloatArray:
    """Return cubic B-splines on evenly spaced knots, shape (n, splines)."""
    inner = np.linspace(time[0], time[-1], splines - 2)
    knots = np.concatenate([[time[0]] * 3, inner, [time[-1]] * 3])
    return np.asarray(BSpline.design_matrix(time, knots, 3).toarray(), dtype=np.float64)


def _correlations(X: FloatArray, y: FloatArray, known: bool) -> list[Correlation]:
    """Return the likeliest correlation of each kind: none, one lag, two lags, lasting."""

    def one(lag: float) -> float:
        return _restricted(X, y, shrunk((lag,)), known)

    def two(lags: FloatArray) -> float:
        return _restricted(X, y, shrunk(tuple(lags.tolist())), known)

    def lasting(size: float) -> float:
        return _restricted(X, y, Correlation(ar=float(np.tanh(size))), known)

    lag = minimize_scalar(one, bounds=(-0.5, 0.5), method="bounded", options={"xatol": 5e-3}).x
    options = {
        "xatol": 5e-3,
        "fatol": 0.05,
        "initial_simplex": [[lag, 0.0], [lag, -0.1], [0.0, 0.1]],
    }
    lags = minimize(two, [lag, 0.0], method="Nelder-Mead", options=options).x
    # Where its size is not known, noise as slow as the curve would be taken for the curve.
    slowest = LARGEST_AR if known else float(np.exp(-3.0 * (X.shape[1] - 3) / len(y)))
    limits = (-1.5, float(np.arctanh(slowest)))
    ar = minimize_scalar(lasting, bounds=limits, method="bounded", options={"xatol": 5e-3}).x
    return [
        Correlation(),
        shrunk((float(lag),)),
        shrunk(tuple(lags.tolist())),
        Correlation(ar=float(np.tanh(ar))),
    ]


def _restricted(X: FloatArray, y: FloatArray, correlation: Correlation, known: bool) -> float:
    """Return -2 log of the restricted likelihood, up to a constant."""
    white, log_det = correlation.whiten(np.column_stack([X, y]))
    R = np.asarray(np.linalg.qr(white, mode="r"))
    rest = len(y) - X.shape[1]
    squares = max(float(R[-1, -1] ** 2), LEAST_SQUARES)
    log_curve = 2.0 * float(np.log(np.abs(np.diag(R)[:-1])).sum())
    return log_det + log_curve + (squares if known else rest * np.log(squares / rest))


def _fit(X: FloatArray, y: FloatArray, shape: FloatArray, found: Correlation, known: bool) -> _Fit:
    """Fit the curve, and judge it by BIC: -2 log likelihood + numbers fitted * log n."""
    white, log_det = found.whiten(np.column_stack([X, y]))
    basis, R = np.linalg.qr(white[:, :-1], mode="reduced")
    part = basis.T @ white[:, -1]
    scatter = white[:, -1] - basis @ part
    n, splines = X.shape
    squares = max(float(scatter @ scatter), LEAST_SQUARES)
    scale = float(np.sqrt(squares / (n - splines)))
    misfit = squares if known else n * np.log(squares / n)
    return _Fit(
        criterion=log_det + misfit + (splines + found.numbers) * np.log(n),
        correlation=found,
        scale=scale,
        curve=shape * (X @ np.linalg.solve(R, part)),
        scatter=scatter / scale,
        basis=basis,
    )
