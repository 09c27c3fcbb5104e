"""Windows in which a signal is missed by a constant number of standard deviations of its noise.

For each window of a signal, the misfit d is s(t), the standard deviation of its noise with lasting
errors, inside the window and zero outside. Its size has the least squares estimate of the whitened
residuals w, and this over its standard deviation is

    z = v^T w / |v|,    v = (I - Q Q^T) L^-1 d.

Q spans what the parameters absorb, L^-1 whitens. The statistic of a signal is the largest
|z| - sqrt(2 log(n/l)) over its windows of l of n points: short windows, of which there are many,
must stand out more (Duembgen and Spokoiny 2001, doi 10.1214/aos/996986504). Errors of the apparatus
that last, as a drift, are in L. Whitening then leaves little of a lasting misfit but its ends, so
that sums of whitened residuals hardly show it.
"""

import numpy as np

from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray

DRAWS = 1000
"""Draws of noise that give the distribution."""
MOST_BINS = 128
"""Bins of a signal at whose ends windows begin and end; each point of a short signal is one."""
ABSORBED = 1e-6
"""Share of the variance of z below which the parameters absorb all of a window."""


def largest(
    likelihood: Likelihood, residuals: list[FloatArray], spanned: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the statistic of each signal, and that of draws of its noise.

    The shapes are (signals,) and (draws, signals).

    Parameters
    ----------
    likelihood
        With the noise of the signals.
    residuals
        w of each signal, shape (points,).
    spanned
        Q, orthonormal, shape (all points, parameters).
    """
    rng = np.random.default_rng(0)
    pairs = zip(likelihood.noise, likelihood.split(spanned), strict=True)
    signals = [_Signal(noise, own) for noise, own in pairs]
    drawn = [signal.drawn(rng) for signal in signals]
    absorbed = np.sum([inside for _, inside in drawn], axis=0)
    of_noise = [
        signal.largest(sums - linear.product(signal.slopes, absorbed))
        for signal, (sums, _) in zip(signals, drawn, strict=True)
    ]
    shown = [
        signal.largest(linear.product(signal.rows.T, w)[:, None])[0]
        for signal, w in zip(signals, residuals, strict=True)
    ]
    return np.array(shown), np.stack(of_noise, axis=1)


class _Signal:
    """Whitened misfits of the bins of a signal, and the covariance of their sums."""

    def __init__(self, noise: NoiseModel, spanned: FloatArray) -> None:
        points = noise.sd.size
        count = min(points, MOST_BINS)
        bins = np.arange(points) * count // points
        steps = np.where(bins[:, None] == np.arange(count), noise.total_sd[:, None], 0.0)
        self.rows, self.spanned = noise.whiten(steps), spanned
        self.slopes = linear.product(self.rows.T, spanned)
        whole = linear.gram(self.rows)
        self._variance = _of_windows(whole - linear.product(self.slopes, self.slopes.T))
        self._whole = _of_windows(whole)

    def drawn(self, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
        """Return sums over the bins, and the coordinates by Q, of draws of white noise."""
        _, R = linear.qr(np.column_stack([self.rows, self.spanned]))
        found = linear.product(R.T, rng.standard_normal((len(R), DRAWS)))
        return found[: self.rows.shape[1]], found[self.rows.shape[1] :]

    def largest(self, sums: FloatArray) -> FloatArray:
        """Return the largest statistic of sums over the bins, (bins, draws), shape (draws,)."""
        bins, draws = sums.shape
        total = np.concatenate([np.zeros((1, draws)), np.cumsum(sums, axis=0)])
        found = np.full(draws, -np.inf)
        for length in range(1, bins + 1):
            variance, whole = self._variance[length], self._whole[length]
            sd = np.sqrt(np.where(variance > ABSORBED * whole, variance, np.inf))
            z = np.abs(total[length:] - total[:-length]) / sd[:, None]
            handicap = np.sqrt(2.0 * functions.log(bins / length))
            found = np.maximum(found, z.max(axis=0) - handicap)
        return found


def _of_windows(covariance: FloatArray) -> list[FloatArray]:
    """Return the variance of the sum over each window, by its length, from that of the bins.

    >>> [v.tolist() for v in _of_windows(np.array([[1.0, 0.5], [0.5, 2.0]]))[1:]]
    [[1.0, 2.0], [4.0]]
    """
    bins = len(covariance)
    total = np.zeros((bins + 1, bins + 1))
    total[1:, 1:] = np.cumsum(np.cumsum(covariance, axis=0), axis=1)
    diagonal = np.diag(total)
    return [np.zeros(0)] + [
        diagonal[k:] - 2.0 * np.diag(total, k) + diagonal[:-k] for k in range(1, bins + 1)
    ]
