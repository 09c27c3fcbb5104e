"""Statistics that compare fitted models of the same measurements, under one noise.

All models are judged by the noise of the one that misses the measurements least. Its whitened
residuals w still last where it misses them, so their points tell less. The factor f is their
spectral density at low frequencies, from the cosines of the lowest ones (Mueller 2007, doi
10.1016/j.jeconom.2007.01.019). With M = C^T (I - Q Q^T) C = V diag(m) V^T of the first 8 cosines C
and what the fit absorbs, Q,

    f = mean over j of z_j^2 / m_j,    z = V^T C^T w,

over the nu values with m_j above 0.3. It has nu degrees of freedom. The variance of a signal's
noise counts as f times as large, and its n points as

    n_eff = n mean(w^2) / f    (Bayley and Hammersley 1946, doi 10.2307/2983560)

where the misfit exceeds what noise hardly reaches; elsewhere f = 1 and n_eff = n. A clear misfit of
shorter waves has the long-run variance of `pyrofit.diagnose.base.long_run` for f.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.fft import dct
from scipy.special import chdtri, fdtrc

from pyrofit.diagnose.base.long_run import long_run_variance
from pyrofit.diagnose.base.prediction import score_forecast
from pyrofit.estimate.bounded_least_squares import Fit
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.projection import projector
from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray

COSINES = 8
"""Cosines of the lowest frequencies; a misfit lasts over a tenth of a record and more."""
LEAST_LEFT = 0.3
"""Least share m of their variance that a fit leaves."""
LASTING_LEVEL = 0.3
"""Probability at which errors count as lasting. Missing some costs more than suspecting some."""
LARGER_LEVEL = 1e-3
"""Probability at which points count as scattering more than their noise."""


@dataclass(frozen=True, eq=False)
class CommonNoise:
    """The noise under which models are compared, by signal, and the points that it leaves.

    Parameters
    ----------
    noise
        Of each signal, its variance f times that of the noise alone.
    effective
        n_eff of each signal.
    freedom
        Degrees of freedom of each f, infinite where it is 1.
    """

    noise: tuple[NoiseModel, ...]
    effective: tuple[float, ...]
    freedom: tuple[float, ...]


def common_noise(best: Likelihood, fit: Fit) -> CommonNoise:
    """Return the noise that the residuals of the best model ask for, and its points."""
    spanned = projector(fit)[: sum(best.points)]
    parts = best.split(fit.residuals)
    found = [inflation_of(w, Q) for w, Q in zip(parts, best.split(spanned), strict=True)]
    factors, freedoms = zip(*found, strict=True)
    noise = [n.weighted(1.0 / np.sqrt(f)) for n, f in zip(best.noise, factors, strict=True)]
    return CommonNoise(
        tuple(noise),
        tuple(effective_points(w, f) for w, f in zip(parts, factors, strict=True)),
        freedoms,
    )


def inflation_of(w: FloatArray, spanned: FloatArray) -> tuple[float, float]:
    """Return f of a signal and its degrees of freedom: 1 and infinity where w are like noise.

    Parameters
    ----------
    w
        Whitened residuals, shape (n,).
    spanned
        Rows of the signal of an orthonormal basis Q of what the fit absorbs, shape (n, k).
    """
    n = w.size
    raw, absorbed = (dct(of, norm="ortho", axis=0)[1 : COSINES + 1] for of in (w, spanned))
    m, V = linear.eigen(np.eye(raw.size) - linear.gram(absorbed.T))
    z = linear.product(V.T, raw)
    kept = m > LEAST_LEFT
    nu, square = int(np.count_nonzero(kept)), float(np.mean(w**2))
    low = float(np.mean(z[kept] ** 2 / m[kept])) if nu else square
    if nu and low * nu > float(chdtri(nu, LASTING_LEVEL)) and low > square:
        return max(low, 1.0), float(nu)
    if square * n <= float(chdtri(n, LARGER_LEVEL)):
        return 1.0, np.inf
    # A clear misfit may last for less than the cosines tell.
    waves = long_run_variance(w)
    return (waves, max(float(nu), 1.0)) if waves > square else (square, float(n))


def effective_points(w: FloatArray, factor: float) -> float:
    """Return how many independent points tell as much as those of whitened residuals.

    >>> effective_points(np.ones(100), 10.0), effective_points(0.9 * np.ones(100), 1.0)
    (10.0, 100.0)
    """
    return float(w.size) if factor <= 1.0 else w.size * min(1.0, float(np.mean(w**2)) / factor)


def descended(likelihood: Likelihood, noise: Sequence[NoiseModel], x: FloatArray) -> Fit:
    """Return the fit under another noise, from x, with derivatives at its end."""
    under = replace(likelihood, noise=tuple(noise))
    found = under.descend(x)
    if found.fresh:
        return found
    return replace(found, slopes=under.jacobian(found.x, found.residuals), fresh=True)


def aicc(chi2: float, parameters: int, points: float) -> float:
    """Return Akaike's criterion for few points; infinite where there are too few.

    chi2 + 2 k + 2 k (k + 1) / (n - k - 1) (Hurvich and Tsai 1989, doi 10.1093/biomet/76.2.297).

    >>> aicc(10.0, 2, 15.0), aicc(10.0, 2, 3.0)
    (15.0, inf)
    """
    rest = points - parameters - 1.0
    few = 2.0 * parameters * (parameters + 1.0) / rest if rest > 0.0 else np.inf
    return chi2 + 2.0 * parameters + few


def bic(chi2: float, parameters: int, points: float) -> float:
    """Return Schwarz's criterion chi2 + k ln n (1978, doi 10.1214/aos/1176344136).

    >>> bic(10.0, 2, 1.0)
    10.0
    """
    return chi2 + parameters * float(functions.log(points))


def akaike_weights(criteria: FloatArray) -> FloatArray:
    """Return exp(-d/2), d above the least, over its sum (Burnham and Anderson 2002).

    >>> akaike_weights(np.array([3.0, 3.0, np.inf])).tolist()
    [0.5, 0.5, 0.0]
    """
    if not np.isfinite(criteria).any():
        return np.full(criteria.size, np.nan)
    weights = functions.exp(-0.5 * (criteria - criteria.min()))
    return np.asarray(weights / weights.sum())


def f_test(chi2: float, chi2_of_larger: float, added: int, freedom: float) -> tuple[float, float]:
    """Return F of a larger model and the probability that noise alone gains as much.

    F = ((chi2 - chi2_l) / added) / (chi2_l / freedom), of Fisher's distribution with ``added`` and
    ``freedom`` degrees of freedom if the smaller model is right (Bates and Watts 1988, 3.10,
    doi 10.1002/9780470316757). NaN where there is no freedom.

    >>> [round(x, 4) for x in f_test(14.965, 10.0, 1, 10.0)]
    [4.965, 0.05]
    """
    if freedom <= 0.0:
        return np.nan, np.nan
    F = max(chi2 - chi2_of_larger, 0.0) / added / (chi2_of_larger / freedom)
    return F, float(fdtrc(added, freedom, F))


def f_test_of_lasting(
    smaller: Sequence[FloatArray], larger: Sequence[FloatArray], added: int, common: CommonNoise
) -> tuple[float, float]:
    """Return F of a larger model where errors last, and its probability.

    F is the gain of chi-square over ``added``, as the variance f is that of the noise. It has the
    degrees of freedom of f, pooled over signals by their gains g: (sum g)^2 / sum (g^2 / nu)
    (Satterthwaite 1946, doi 10.2307/3002019).

    Parameters
    ----------
    smaller, larger
        Whitened residuals of both models by signal, shape (n,) each.
    """
    pairs = zip(smaller, larger, strict=True)
    gains = np.array([linear.dot(a, a) - linear.dot(b, b) for a, b in pairs])
    F, sizes = max(float(gains.sum()), 0.0) / added, np.maximum(np.abs(gains), 1e-12)
    spread = float(np.sum(sizes**2 / np.array(common.freedom)))
    freedom = min(float(np.sum(sizes)) ** 2 / max(spread, 1e-300), sum(common.effective))
    return F, float(fdtrc(added, freedom, F))


@dataclass(frozen=True)
class LeftOut:
    """How a model predicts tests that are left out of its fit.

    Parameters
    ----------
    log_score
        Log density of the measured points, but for a constant of the noise.
    squares
        Mean square of predicted minus measured values over the range of each signal, by signal.
    """

    log_score: float
    squares: tuple[float, ...]


def predicted_score(whole: Fit, likelihood: Likelihood, part: Fit, left: Sequence[int]) -> LeftOut:
    """Return the score of signals that a part of a model's fit predicts.

    Parameters
    ----------
    whole
        The fit to all signals, under ``likelihood``.
    part
        The fit to the others.
    left
        Positions of the signals that are left out.
    """
    curves = likelihood.curves(part.x)
    squares = [np.inf] * len(left)
    if curves is not None:
        parts, terms = likelihood.split(curves), likelihood.problem.cost.terms
        squares = [_relative_square(parts[k], terms[k][1].target.value) for k in left]
    return LeftOut(score_forecast(part, whole), tuple(squares))


def _relative_square(curve: FloatArray, value: FloatArray) -> float:
    return float(np.mean((curve - value) ** 2) / max(float(np.ptp(value)), 1e-300) ** 2)
