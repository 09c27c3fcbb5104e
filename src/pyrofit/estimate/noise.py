"""The noise of a measured series: its scatter about a smooth curve, and known errors."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from pyrofit.cost import Target
from pyrofit.errors import DataError
from pyrofit.estimate.apparatus import LASTING, apparatus_error
from pyrofit.estimate.correlation import Correlation, whiteness
from pyrofit.estimate.scatter import scatter_of
from pyrofit.estimate.spikes import spikes
from pyrofit.model.signal import TIMING_S
from pyrofit.numerics import functions, linear, roots
from pyrofit.quantities.base import Quantity, Shown
from pyrofit.solver.arrays import FloatArray

SMOOTHING = 0.1
"""Window over which a stated uncertainty is smoothed, as a fraction of the record."""
_ROWS = 64
"""Points that are smoothed together: a window of all has the square of their number."""
FEWEST_POINTS = 8
UNITLESS = Shown("–")
REPEATS, ENDS = "repeats", "ends"
TERMS = {
    "timing": "error of the clock",
    "solver": "error of the solver",
    "discrepancy": "model discrepancy",
    "drift": "drift of the apparatus",
    "sensitivity": "error of its sensitivity",
    "temperature": "error of the temperature",
    REPEATS: "scatter between repeats",
    ENDS: "difference of the ends of records",
}
"""Terms that are added to a standard deviation, in words."""


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
        Scatter about that curve over the stated one, 1 where it is not significantly larger.
    whiteness
        Probability that white noise looks as correlated as the whitened scatter (Ljung-Box).
    origin
        Where the standard deviation comes from, in words.
    shown
        Unit of the series in words, and its factor.
    floors
        Medians of the terms added to the standard deviation in squares, by name.
    """

    sd: FloatArray
    correlation: Correlation
    splines: int = 0
    excess: float = 1.0
    whiteness: float = 1.0
    origin: str = "given"
    shown: Shown = UNITLESS
    floors: Mapping[str, float] = field(default_factory=dict)
    criterion: float = math.inf
    """BIC of curve and scatter, the lower the better."""
    stated: bool = False
    """Whether the series has an uncertainty of its own."""
    spikes: int = 0
    """Single points far off their neighbours. That distance counts as their noise."""
    weight: FloatArray | float = 1.0
    """Weight by which a caller divides the noise, a number or shape (n,)."""
    modes: FloatArray | None = None
    """Lasting errors U of the apparatus and between repeats, which add U U^T to the covariance,
    shape (n, modes)."""
    caution: FloatArray | None = None
    """Factors of the modes, 1 at least, shape (modes,), that intervals and tests take: few repeats
    may hide errors. They do not weigh the points."""

    between: int = 0
    """Number of modes, the last ones, that are the scatter between records."""

    @property
    def alone(self) -> "NoiseModel":
        """The noise without the scatter between records."""
        if self.modes is None or not self.between:
            return self
        own = self.modes[:, : -self.between]
        floors = {name: size for name, size in self.floors.items() if name not in (REPEATS, ENDS)}
        modes = own if own.shape[1] else None
        return replace(self, modes=modes, caution=None, between=0, floors=floors)

    @cached_property
    def cautious(self) -> "NoiseModel":
        """The noise with the errors that few repeats may hide."""
        if self.modes is None or self.caution is None:
            return self
        return replace(self, modes=self.modes * self.caution, caution=None)

    @property
    def hidden(self) -> FloatArray | None:
        """Errors that few repeats may hide, shape (n, modes), beside those of the modes."""
        if self.modes is None or self.caution is None:
            return None
        raised = self.caution > 1.0
        return self.modes[:, raised] * np.sqrt(self.caution[raised] ** 2 - 1.0)

    @property
    def total_sd(self) -> FloatArray:
        """Standard deviation with lasting errors, shape (n,)."""
        if self.modes is None:
            return self.sd
        return np.asarray(np.sqrt(self.sd**2 + np.sum(self.modes**2, axis=1)))

    @property
    def lasting_sd(self) -> FloatArray:
        """Standard deviation of the lasting errors, shape (n,)."""
        if self.modes is None:
            return np.zeros_like(self.sd)
        return np.asarray(np.sqrt(np.sum(self.modes**2, axis=1)))

    def weighted(self, weight: FloatArray | float) -> "NoiseModel":
        """Return the noise that counts as 1/w of its size, w a number or shape (n,)."""
        modes = self.modes
        if modes is not None:
            modes = modes / np.broadcast_to(weight, self.sd.shape)[:, None]
        return replace(self, sd=self.sd / weight, modes=modes, weight=self.weight * weight)

    def whiten(self, residual: FloatArray) -> FloatArray:
        """Return w = L^-1 (r / sd): white and of unit variance if the residual is this noise.

        With lasting errors, w = (I + V V^T)^(-1/2) L^-1 (r / sd), V = L^-1 (U / sd).

        Parameters
        ----------
        residual
            r, shape (n,) or (n, k), in the unit of the series.
        """
        white = self._white_alone(residual)
        if self.modes is None:
            return white
        B, F = self._lasting
        inside = linear.product(F, linear.product(B.T, white))
        return np.asarray(white - linear.product(B, inside))

    def covariance_with(self, x: FloatArray) -> FloatArray:
        """Return C x of the covariance C of the noise, x of shape (n, k)."""
        found = self.sd[:, None] * self.correlation.product(self.sd[:, None] * x)
        if self.modes is None:
            return found
        return np.asarray(found + linear.product(self.modes, linear.product(self.modes.T, x)))

    def _white_alone(self, residual: FloatArray) -> FloatArray:
        sd = self.sd if residual.ndim == 1 else self.sd[:, None]
        return self.correlation.whiten(residual / sd)

    @cached_property
    def _lasting(self) -> tuple[FloatArray, FloatArray]:
        """B and F of (I + V V^T)^(-1/2) = I - B F B^T."""
        assert self.modes is not None
        return roots.whitening(self._white_alone(self.modes))

    def describe(self) -> str:
        """Say its size, where that comes from, its correlation, and whether it whitens."""
        unit = {"°C": " K", "–": ""}.get(self.shown.unit, f" {self.shown.unit}")
        more = f"; the scatter is {self.excess:.2g} times that" if self.excess > 1.0 else ""
        more += f"; outliers that count little: {self.spikes}" if self.spikes else ""
        parts = [f"{TERMS[name]} {self._shown(size)}" for name, size in self.floors.items()]
        terms = f". Standard deviations added in quadrature: {', '.join(parts)}" if parts else ""
        return (
            f"Median standard deviation {self._shown(np.median(self.total_sd))}{unit}, "
            f"{self.origin}{more}{terms}. {self.correlation.describe().capitalize()}"
            f"{self._tested()}."
        )

    def _shown(self, size: Any) -> str:
        return f"{self.shown.factor * float(size):.2g}"

    def _tested(self) -> str:
        """Say whether the scatter is white once whitened, where that correlation is taken."""
        if "discrepancy" in self.floors:
            return ""
        left = "no correlation" if self.white else "correlation"
        return f"; {left} is left after that (Ljung-Box, p = {self.whiteness:.2g})"

    @property
    def white(self) -> bool:
        """Whether the whitened scatter may be white, at the level of 5 %."""
        return "discrepancy" in self.floors or self.whiteness >= 0.05


def estimate_noise(
    target: Target,
    quantity: Quantity,
    stated_sds: float = 1.0,
    timing_s: float = TIMING_S,
    about: FloatArray | None = None,
    *,
    temperature_K: FloatArray | None = None,
    drift: float | None = None,
    tolerant: bool = False,
) -> NoiseModel:
    """Estimate size and correlation of the noise of a measured series.

    Parameters
    ----------
    target
        The series. A stated standard deviation counts in full: where points scatter less about a
        smooth curve, the rest is taken to vary slowly.
    quantity
        The measured quantity, with the floors of its noise.
    stated_sds
        Standard deviations that the stated uncertainty stands for.
    timing_s
        Error of the clock [s]; it counts where the curve is steep.
    about
        A simulated curve, shape (n,), where one is at hand. The noise is then the scatter about the
        sum of that and a smooth one, which need not follow steep parts.
    temperature_K
        Measured temperatures, shape (n,), if the series is recorded against them.
    drift
        Standard deviation of a lasting error that a study states.
    tolerant
        Whether the noise includes the usual discrepancy of models instead of the errors of the
        apparatus. It hides a misfit of that size.

    Single points far off their neighbours (`spikes`) do not count in this estimate, and get that
    distance as an additional standard deviation.

    Raises
    ------
    DataError
        The series has fewer than 8 points and no stated uncertainty, or all its values are equal.
    """
    count = target.value.size
    if np.ptp(target.value) == 0.0:
        raise DataError(
            f"{quantity.name}: all {count} values are equal: the record shows neither noise nor a "
            "reaction; give another column, or do not fit the signal"
        )
    stated = smoothed(target)
    stated = None if stated is None else stated / stated_sds
    if count < FEWEST_POINTS:
        return _of_few_points(stated, count, quantity)
    shape = np.ones(count) if stated is None else stated
    near = np.zeros(count) if about is None else about
    off = spikes(target.value)
    fit = scatter_of(target.time_s, target.value - near - off, shape, stated is not None)
    larger = fit.scale > 1.0 + np.sqrt(2.0 / (count - fit.splines))
    scale = fit.scale if stated is None or larger else 1.0
    curve = near + fit.curve
    floors = _floors(target, curve, quantity, timing_s)
    discrepancy = drift or quantity.discrepancy or quantity.discrepancy_share * float(np.ptp(curve))
    lasting = None
    if stated is None and not tolerant:
        time = target.time_s
        lasting = apparatus_error(quantity, time, curve, temperature_K, timing_s, drift)
        if lasting is not None:
            del floors["timing"]
    elif stated is None and discrepancy:
        floors["discrepancy"] = np.full(count, discrepancy)
    correlation = fit.correlation
    origin = "from the scatter" if stated is None else "stated, smoothed over 10 % of the record"
    if "discrepancy" in floors:
        correlation = Correlation(ar=float(functions.exp(-1.0 / (LASTING * (count - 1)))))
        origin = "discrepancy of models, lasting over 10 % of the record"
    squares = (scale * shape) ** 2 + sum(floor**2 for floor in floors.values()) + off**2
    return NoiseModel(
        sd=np.sqrt(squares),
        correlation=correlation,
        splines=fit.splines,
        excess=1.0 if stated is None else scale,
        whiteness=whiteness(fit.scatter, fit.basis),
        origin=origin,
        shown=quantity.shown,
        floors={name: float(np.median(floor)) for name, floor in floors.items()}
        | ({} if lasting is None else dict(lasting.sizes)),
        modes=None if lasting is None else lasting.modes,
        criterion=fit.criterion,
        stated=stated is not None,
        spikes=int(np.count_nonzero(off)),
    )


def _of_few_points(stated: FloatArray | None, count: int, quantity: Quantity) -> NoiseModel:
    if stated is None:
        raise DataError(
            f"{quantity.name}: {count} points tell nothing of their noise, at least "
            f"{FEWEST_POINTS} do; give an uncertainty, or do not fit the signal"
        )
    return NoiseModel(stated, Correlation(), origin="stated", shown=quantity.shown, stated=True)


def smoothed(target: Target) -> FloatArray | None:
    """Return the stated uncertainty smoothed over time, None where none is stated.

    The logarithm is averaged with a Gaussian window, and the local mean square restored. An
    uncertainty from two repeats jumps from point to point; one value means no more than the next.
    """
    given = target.uncertainty
    if given is None or not np.any(given > 0.0):
        return None
    safe = np.maximum(given, 1e-3 * np.max(given))
    width = 0.25 * SMOOTHING * (target.time_s[-1] - target.time_s[0])
    shape = functions.exp(_local_mean(target.time_s, functions.log(safe), width))
    return np.asarray(shape * np.sqrt(_local_mean(target.time_s, (safe / shape) ** 2, width)))


def _local_mean(time: FloatArray, values: FloatArray, width: float) -> FloatArray:
    """Return the mean of values over a Gaussian window about each time, shape (n,)."""
    found = np.empty(values.size)
    for first in range(0, values.size, _ROWS):
        rows = slice(first, first + _ROWS)
        window = functions.exp(-0.5 * (np.subtract.outer(time[rows], time) / width) ** 2)
        window /= window.sum(axis=1, keepdims=True)
        found[rows] = linear.product(window, values)
    return found


def _floors(
    target: Target, curve: FloatArray, quantity: Quantity, timing_s: float
) -> dict[str, FloatArray]:
    """Return the additions to the standard deviation of every point, shape (n,) each."""
    slope = np.abs(np.gradient(curve, target.time_s))
    return {
        "timing": timing_s * slope,
        "solver": np.full(curve.size, quantity.solver_error * np.ptp(curve)),
    }
