"""Errors of an apparatus that last: drift, sensitivity, temperature.

One record does not show them, since a smooth curve follows them as it follows the sample. They are
taken as random effects of the record, u = U z with z ~ N(0, I), that add U U^T to the covariance of
its noise. For a curve f(t) they are a drift of standard deviation d, which lasts over 10 % of the
record, and a relative error s of the sensitivity. T is the error of the temperature, c that of the
clock:

    U U^T = d^2 exp(-|t - t'|/l) + s^2 f f^T + T^2 (df/dT) (df/dT)^T
            + c^2 (df/dt) (df/dt)^T.

If the temperature is held, df/dT is a t df/dt instead: the error speeds up the reaction by a share
a per kelvin.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pyrofit.estimate.repeats_agree import is_held
from pyrofit.numerics import functions, linear
from pyrofit.quantities.base import Quantity
from pyrofit.solver.arrays import FloatArray

LASTING = 0.1
"""Time over which an error lasts, as a fraction of the record. It counts alike however many points
are measured."""
FASTER_PER_K = 0.06
"""a, E/(R T^2) of 180 kJ/mol at 600 K."""
KNOTS = 41
"""Knots of a record, between which a drift is interpolated."""


@dataclass(frozen=True, eq=False)
class ApparatusError:
    """Modes U of the lasting errors of a record, shape (n, modes), and their median sizes."""

    modes: FloatArray
    sizes: Mapping[str, float]


def apparatus_error(
    quantity: Quantity,
    time: FloatArray,
    curve: FloatArray,
    temperature_K: FloatArray | None,
    timing_s: float,
    drift: float | None = None,
) -> ApparatusError | None:
    """Return the lasting errors of a record without a stated uncertainty; None if it has none.

    Parameters
    ----------
    quantity
        The measured quantity, with the usual errors of its apparatus.
    time, curve
        Times [s] and a smooth curve through the record, shape (n,).
    temperature_K
        Measured temperatures, shape (n,), where the quantity is recorded against them.
    timing_s
        Error of the clock [s], the same for all points.
    drift
        Standard deviation of a drift that a study states, in the unit of the quantity.
    """
    rise = float(np.ptp(curve))
    drifts = drift or quantity.drift or quantity.drift_share * rise
    parts = {}
    if drifts:
        parts["drift"] = drifts * _drift(time)
    if quantity.sensitivity_error:
        parts["sensitivity"] = quantity.sensitivity_error * curve[:, None]
    if temperature_K is not None and quantity.temperature_error_K:
        slope = _slope(time, curve, temperature_K)
        parts["temperature"] = quantity.temperature_error_K * slope[:, None]
    if not parts:
        return None
    if timing_s:
        parts["timing"] = timing_s * np.gradient(curve, time)[:, None]
    sizes = {name: float(np.median(np.sqrt(np.sum(u**2, axis=1)))) for name, u in parts.items()}
    return ApparatusError(np.column_stack(list(parts.values())), sizes)


def _drift(time: FloatArray) -> FloatArray:
    """Return U of a drift of unit variance, shape (n, modes)."""
    knots = np.linspace(time[0], time[-1], KNOTS)
    apart = np.subtract.outer(knots, knots) / (LASTING * (time[-1] - time[0]))
    factor = linear.cholesky(functions.exp(-np.abs(apart)))
    return np.column_stack([np.interp(time, knots, column) for column in factor.T])


def _slope(time: FloatArray, curve: FloatArray, temperature_K: FloatArray) -> FloatArray:
    """Return df/dT, zero where the temperature rests between ramps."""
    if is_held(temperature_K, curve):
        return np.asarray(FASTER_PER_K * (time - time[0]) * np.gradient(curve, time))
    rise, warming = np.gradient(curve), np.gradient(temperature_K)
    usual = float(np.median(np.abs(warming)))
    moves = np.abs(warming) > 0.05 * usual
    return np.where(moves, rise / np.where(moves, warming, 1.0), 0.0)
