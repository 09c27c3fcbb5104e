"""Windows in which a signal is missed, seen in two ways.

**Steps.** For each window of a signal, the misfit d is s(t), the standard deviation of its noise
with lasting errors, inside the window and zero outside. Its size has the least squares estimate of
the whitened residuals w, and this over its standard deviation is

    z = v^T w / |v|,    v = (I - Q Q^T) L^-1 d.

Q spans what the parameters absorb, L^-1 whitens. Errors of the apparatus that last, as a drift, are
in L. Least squares look at the ends of a window then, where noise of that kind cannot jump.

**Means.** A misfit without sharp ends leaves no trace there. So the mean of r/s over each window,
of the residuals r = L w, counts as well. With C = L L^T, the sum over a window is t^T r, and

    z = v^T w / |v|,    v = (I - Q Q^T) L^-1 C t,    t = 1/s inside the window.

The statistic of a signal is the largest |z| - sqrt(2 log(n/l)) over both kinds and all windows of l
of n points. Short windows, of which there are many, must stand out more (Duembgen and Spokoiny
2001, doi 10.1214/aos/996986504).
"""

import numpy as np

from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray

DRAWS = 1000
"""Draws of noise that give the distribution."""
STEP_BINS = 128
MEAN_BINS = 32
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
        signal.largest(sums, absorbed) for signal, (sums, _) in zip(signals, drawn, strict=True)
    ]
    shown = [signal.shown(w) for signal, w in zip(signals, residuals, strict=True)]
    return np.array(shown), np.stack(of_noise, axis=1)


class _Signal:
    """Both kinds of windows of a signal."""

    def __init__(self, noise: NoiseModel, spanned: FloatArray) -> None:
        sd = noise.total_sd[:, None]
        steps = noise.whiten(np.where(_bins(sd.size, STEP_BINS), sd, 0.0))
        means = np.where(_bins(sd.size, MEAN_BINS), 1.0 / sd, 0.0)
        means = noise.whiten(noise.covariance_with(means))
        self.kinds = (_Windows(steps, spanned), _Windows(means, spanned))
        self.spanned = spanned

    def drawn(self, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
        """Return sums over the bins, and the coordinates by Q, of draws of white noise."""
        rows = [kind.rows for kind in self.kinds]
        _, R = linear.qr(np.column_stack([*rows, self.spanned]))
        found = linear.product(R.T, rng.standard_normal((len(R), DRAWS)))
        bins = found.shape[0] - self.spanned.shape[1]
        return found[:bins], found[bins:]

    def largest(self, sums: FloatArray, absorbed: FloatArray) -> FloatArray:
        """Return the statistic of draws less the part that the parameters absorb."""
        own = np.split(sums, [self.kinds[0].rows.shape[1]])
        pairs = zip(self.kinds, own, strict=True)
        found = [kind.largest(s - linear.product(kind.slopes, absorbed)) for kind, s in pairs]
        return np.maximum(*found)

    def shown(self, w: FloatArray) -> float:
        """Return the statistic of residuals."""
        return max(float(k.largest(linear.product(k.rows.T, w)[:, None])[0]) for k in self.kinds)


def _bins(points: int, most: int) -> FloatArray:
    """Return which bin each point is in, shape (points, bins)."""
    count = min(points, most)
    return np.asarray((np.arange(points) * count // points)[:, None] == np.arange(count))


class _Windows:
    """Windows of one kind: rows that make sums over bins, and the covariance of these."""

    def __init__(self, rows: FloatArray, spanned: FloatArray) -> None:
        self.rows = rows
        self.slopes = linear.product(rows.T, spanned)
        whole = linear.gram(rows)
        self._variance = _of_windows(whole - linear.product(self.slopes, self.slopes.T))
        self._whole = _of_windows(whole)

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
