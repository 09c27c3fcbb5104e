"""Whether one reaction of first order describes the records of small samples."""

from collections.abc import Sequence

import numpy as np

from pyrofit.constants import GAS_CONSTANT
from pyrofit.numerics import fitting, functions
from pyrofit.solver.arrays import FloatArray

Record = tuple[FloatArray, FloatArray, FloatArray]
DESCRIBED = 0.008
"""Largest rms misfit over the loss of mass, but for an error of the temperature."""
SHIFT_K = 3.0
"""Largest error of the temperature of a record."""
POINTS = 400
"""Points of a record that count at most."""
USUAL_E_J_MOL = 180e3
RATE_1_S = 0.01
"""Rate constant at half of the loss, about."""


def one_reaction_describes(records: Sequence[Record], half_K: float) -> bool:
    """Fit m = y + (m_0 - y) exp(-int k dt), k of Arrhenius, to all records at once.

    Parameters
    ----------
    records
        Times [s], temperatures [K] and masses of each record, shape (n,) each.
    half_K
        Temperature [K] of half the loss, near which the fit starts.
    """
    few = [_thinned(record) for record in records]

    def residuals(x: FloatArray) -> FloatArray:
        return np.concatenate([_misfit(*record, x, half_K)[0] for record in few])

    start = np.array([float(functions.log(RATE_1_S)), 1.0])
    x = fitting.least_squares(residuals, start, gain=1e-6)
    return all(_rms_shifted(*_misfit(*record, x, half_K), record[1]) < DESCRIBED for record in few)


def _thinned(record: Record) -> Record:
    step = max(1, record[0].size // POINTS)
    return record[0][::step], record[1][::step], record[2][::step]


def _rms_shifted(misfit: FloatArray, curve: FloatArray, temperature: FloatArray) -> float:
    """Return the rms misfit with the best error of the temperature taken out."""
    warming = np.gradient(temperature)
    rests = np.abs(warming) < 0.05 * np.max(np.abs(warming))
    slope = np.where(rests, 0.0, np.gradient(curve) / np.where(rests, 1.0, warming))
    shift = float(np.sum(slope * misfit)) / max(float(np.sum(slope**2)), 1e-300)
    left = misfit - float(np.clip(shift, -SHIFT_K, SHIFT_K)) * slope
    return float(np.sqrt(np.mean(left**2)))


def _misfit(
    time: FloatArray, temperature: FloatArray, mass: FloatArray, x: FloatArray, half_K: float
) -> tuple[FloatArray, FloatArray]:
    """Return misfit and curve over the loss; loss and residue of each record are its best ones.

    ``x`` is ln k [1/s] at ``half_K``, and E over the usual one.
    """
    over_R = x[1] * USUAL_E_J_MOL / GAS_CONSTANT
    rate = functions.exp(np.clip(x[0] + over_R * (1.0 / half_K - 1.0 / temperature), -50.0, 20.0))
    steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(time)
    left = functions.exp(-np.minimum(np.concatenate([[0.0], np.cumsum(steps)]), 700.0))
    off, aside = left - left.mean(), mass - mass.mean()
    loss = float(np.sum(off * aside)) / max(float(np.sum(off**2)), 1e-300)
    span = max(float(np.ptp(mass)), 1e-300)
    return (aside - loss * off) / span, loss * off / span
