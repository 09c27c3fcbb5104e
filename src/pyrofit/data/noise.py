"""Noise of measurements: its autocorrelation, and draws that have exactly that.

Stationary noise e has at lag k the autocorrelation r_k = <e_i e_(i+k)> / <e_i^2>, so r_0 = 1. A
slow instrument makes it positive; a balance whose readings are differenced makes r_1 negative.
"""

from collections.abc import Sequence

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def moving_average(lags: Sequence[float], points: int) -> FloatArray:
    """Return the autocorrelation of noise that is correlated over a few lags only.

    r = 1, r_1 ... r_q, 0, 0 ...: that of a moving average of q + 1 white values.

    Parameters
    ----------
    lags
        r_1 ... r_q [-]; none for white noise.
    points
        Number of points n.

    Returns
    -------
    ndarray
        r_0 ... r_(n-1) [-], shape (n,).

    Examples
    --------
    >>> moving_average([-0.25, -0.2], 5).tolist()
    [1.0, -0.25, -0.2, 0.0, 0.0]
    """
    r = np.zeros(points)
    given = np.array([1.0, *lags])[:points]
    r[: given.size] = given
    return r


def autoregressive(ar: float, points: int) -> FloatArray:
    """Return the autocorrelation of noise of which each value keeps a part of the one before.

    r_k = ar^k, that of e_i = ar e_(i-1) + white; ``ar`` is r_1 [-].

    Examples
    --------
    >>> autoregressive(0.5, 4).tolist()
    [1.0, 0.5, 0.25, 0.125]
    """
    r = np.full(points, ar)
    r[0] = 1.0
    return np.cumprod(r)


def lowest_density(lags: Sequence[float]) -> float:
    """Return the lowest value of the spectral density of a moving average.

    f(w) = 1 + 2 sum_k r_k cos(k w), in cos(w) a sum of Chebyshev polynomials. A series of numbers
    is the autocorrelation of some noise only if f is nowhere negative (Herglotz's theorem).

    Examples
    --------
    Differenced white noise has none at w = 0; more than that, no noise has.

    >>> [round(lowest_density([r]), 12) for r in (-0.5, -0.6)]
    [0.0, -0.2]
    """
    if len(lags) < 3:
        one, two = (*lags, 0.0, 0.0)[:2]
        flat_at = -0.25 * one / two if abs(one) < 4.0 * abs(two) else 1.0
        return min(1.0 + 2.0 * (one * c + two * (2.0 * c * c - 1.0)) for c in (-1.0, 1.0, flat_at))
    density = Chebyshev([1.0, *(2.0 * r for r in lags)])
    flat = density.deriv().roots()
    inside = flat.real[(np.abs(flat.imag) < 1e-9) & (np.abs(flat.real) < 1.0)]
    return float(np.min(density(np.concatenate([[-1.0, 1.0], inside]))))


def draw_noise(autocorrelation: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Draw normal noise of unit variance with exactly the given autocorrelation.

    Each value is its prediction from the values before it, plus white noise of the prediction's
    variance: e_i = sum_k phi_ik e_(i-k) + sqrt(v_i) z_i. The recursion of Levinson and Durbin
    (1960, doi 10.2307/1401322) gives phi and v. The sums are plain and in a fixed order, so equal
    seeds give equal bits with any number of threads of a linear algebra library.

    Parameters
    ----------
    autocorrelation
        r_0 = 1 ... r_(n-1) [-], shape (n,), positive definite.
    rng
        Source of the n standard normal numbers z.

    Returns
    -------
    ndarray
        The noise, shape (n,); white noise is z itself.

    Examples
    --------
    >>> white = np.random.default_rng(1).standard_normal(3)
    >>> noise = draw_noise(autoregressive(0.6, 3), np.random.default_rng(1))
    >>> [round(float(noise[i] - 0.6 * noise[i - 1] - 0.8 * white[i]), 12) for i in (1, 2)]
    [0.0, 0.0]
    """
    r = autocorrelation
    noise = rng.standard_normal(r.size)
    phi = np.empty(0)
    variance = 1.0
    for i in range(1, r.size):
        reflection = (r[i] - np.sum(phi * r[i - 1 : 0 : -1])) / variance
        phi = np.append(phi - reflection * phi[::-1], reflection)
        variance *= 1.0 - reflection**2
        noise[i] = np.sum(phi * noise[i - 1 :: -1]) + np.sqrt(variance) * noise[i]
    return noise
