"""Identifiability: intervals of parameters from the likelihood, and the verdict in words.

Covariance, dispersion and limits are those of `pyrofit.estimate.posterior`. Known values are rows
(x - value) / sd of the residuals, and of their derivatives.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.constants import QUANTILE
from pyrofit.errors import DataError
from pyrofit.estimate.bounded_least_squares import Fit
from pyrofit.estimate.goodness import goodness_of_fit
from pyrofit.estimate.likelihood import Likelihood, fit
from pyrofit.estimate.one_rate import BEYOND, following_from_the_model, follows_with
from pyrofit.estimate.posterior import Posterior, interval, limit_of
from pyrofit.estimate.profile import Interval, Profile, profile_of
from pyrofit.estimate.uncertain_apparatus import moves
from pyrofit.estimate.wrong_model import least_squares, moved_by_apparatus, sds_of_misfit
from pyrofit.numerics import linear
from pyrofit.results.goodness import APPARENT, AS_DESCRIBED, MISFIT, ONE_RATE, Goodness
from pyrofit.solver.arrays import FloatArray

DETERMINED = 0.20
WEAKLY = 0.50
"""Widest 95 % intervals of a determined, of a weakly determined parameter [search range]."""
PARABOLIC = 0.2
"""Departure of chi-square from its parabola that is tolerated at the ends of an interval."""
WEIGHINGS = 3
"""How often known values are weighed against a misfit that they change."""
RESTARTS = 3
"""How often a lower chi-square found by a profile starts the analysis again."""
LOWER = 0.01
"""A chi-square is lower if it is so by more."""
SURE, WEAK = "determined", "weakly determined"
LINEAR, PROFILE = "linear", "profile"
"""How an interval was made, see `Estimate`."""


@dataclass(frozen=True)
class Estimate:
    """Estimate and interval of one parameter, in distances of its limits.

    Parameters
    ----------
    x
        Estimate.
    sd
        Standard deviation of the parabola, widened by the dispersion.
    apparatus
        Standard deviation by usual errors of the apparatus, see
        `pyrofit.estimate.uncertain_apparatus`. It is part of ``sd`` where the model misses the
        tests.
    most
        The largest of these errors in words; empty where there is none.
    noise
        Interval if the noise were all that keeps model and data apart.
    interval
        The same with chi-square divided by its value per degree of freedom, where that exceeds 1.
        Where the model misses the tests, estimate and interval are those of
        `pyrofit.estimate.wrong_model`.
    method
        'linear', of the parabola, 'profile', or 'misfit', of a model that misses the tests.
    bound
        'lower' or 'upper' where the estimate is at a limit, else empty.
    """

    name: str
    x: float
    sd: float
    apparatus: float
    most: str
    noise: Interval
    interval: Interval
    method: str
    bound: str
    tied: bool = False
    """Whether another parameter is at a limit, and would move this one out of its interval if it
    went beyond by `BEYOND`."""
    one_rate: bool = False
    """Whether it follows from the reaction that the model assumes, as tests at one heating rate are
    fitted. So does one that `follows_with` such parameters."""

    @property
    def verdict(self) -> str:
        """Whether the data determine it, in words."""
        found = verdict(self.interval.width, self.bound, self.method != MISFIT)
        if found in (SURE, WEAK) and self.one_rate:
            return ONE_RATE
        if found == SURE and self.tied:
            return WEAK
        with_apparatus = math.hypot(self.interval.width, 2.0 * QUANTILE * self.apparatus)
        return AS_DESCRIBED if found == SURE and with_apparatus > DETERMINED else found


def verdict(width: float, bound: str, fits: bool = True) -> str:
    """Say whether the data determine a parameter, from the width of its interval.

    At a limit a narrow interval is the limit's doing: the parameter is not called determined. If
    the model misses the tests, its parameters are apparent values at best.

    >>> verdict(0.2, ""), verdict(0.2, "lower"), verdict(0.9, "upper")
    ('determined', 'at its lower limit', 'undetermined, at its upper limit')
    >>> verdict(0.2, "", fits=False)
    'apparent value'
    """
    if width > WEAKLY:
        return f"undetermined, at its {bound} limit" if bound else "undetermined"
    if bound:
        return f"at its {bound} limit"
    if not fits:
        return APPARENT
    return SURE if width <= DETERMINED else WEAK


@dataclass(frozen=True, eq=False)
class Identification:
    """The analysis: optimum, derivatives there, estimates, profiles.

    ``slopes`` are d curve / d parameter in the unit of each channel, (points, parameters).
    """

    optimum: Fit
    posterior: Posterior
    slopes: FloatArray
    estimates: tuple[Estimate, ...]
    profiles: dict[str, Profile]
    goodness: Goodness

    @property
    def correlation(self) -> FloatArray:
        """Correlation of the estimates, shape (parameters, parameters).

        A parameter that rests at a limit does not move with the others.
        """
        free = [k for k, v in enumerate(self.optimum.x) if not limit_of(v)]
        covariance = self.posterior.covariance(free)
        sd = np.sqrt(np.diag(covariance))
        found = np.eye(self.optimum.x.size)
        found[np.ix_(free, free)] = covariance / np.outer(sd, sd)
        return found

    def modes(self) -> tuple[FloatArray, FloatArray]:
        """Return singular values of the Jacobian and, by column, the directions they belong to.

        A combination of parameters whose value is s has the standard deviation 1/s. The largest
        component of a direction is positive.
        """
        _, values, rows = linear.svd(self.posterior.jacobian)
        largest = rows[np.arange(len(rows)), np.argmax(np.abs(rows), axis=1)]
        return values, (rows * np.sign(largest)[:, None]).T


def identify(
    likelihood: Likelihood, starts: Sequence[FloatArray], profiles: bool = True
) -> Identification:
    """Find the least chi-square from scaled starts, and how far each parameter may be from it.

    Without ``profiles`` all intervals are linear: fast, but too narrow or too wide where chi-square
    is no parabola. All are linear as well where the model misses its tests.

    Raises
    ------
    DataError
        The best set does not finish.
    """
    weighed, optimum = _weighed(likelihood, fit(likelihood, starts))
    for _ in range(RESTARTS):
        curves, slopes = _finished(likelihood, optimum.x), likelihood.slopes(optimum.x)
        posterior = likelihood.posterior(optimum.x, slopes)
        goodness = _tested(likelihood, optimum.x, slopes, curves)
        if not goodness.passes:
            return _of_wrong_model(likelihood, optimum.x, goodness)
        estimates, found, lowest = _around(weighed, optimum, posterior, profiles)
        if lowest.chi2 >= optimum.chi2 - LOWER:
            break
        optimum = weighed.descend(lowest.x)
    return Identification(optimum, posterior, slopes, estimates, found, goodness)


def _finished(likelihood: Likelihood, x: FloatArray) -> FloatArray:
    curves = likelihood.curves(x)
    if curves is None:
        raise DataError(
            "no run from any start finishes; check the limits of the parameters and the "
            "description of the experiments"
        )
    return curves


def _of_wrong_model(likelihood: Likelihood, x: FloatArray, tested: Goodness) -> Identification:
    """Return the analysis of a model that misses the tests, all intervals linear."""
    plain, x = least_squares(likelihood, x)
    curves, slopes = _finished(likelihood, x), likelihood.slopes(x)
    posterior = likelihood.posterior(x, slopes)
    apparatus, most = moved_by_apparatus(plain, x, slopes)
    misfit = sds_of_misfit(likelihood, plain, x, slopes, curves)
    of_noise = np.sqrt(np.diag(posterior.covariance(None, 1.0)))
    # Few repeats may hide more than the misfit shows.
    sds = np.hypot(np.maximum(misfit, of_noise), apparatus).tolist()
    estimates = tuple(
        Estimate(
            name,
            at,
            sd,
            sd_of_apparatus,
            largest,
            Interval(*interval(at, s)),
            Interval(*interval(at, sd)),
            MISFIT,
            limit_of(at),
        )
        for name, at, sd, sd_of_apparatus, largest, s in zip(
            likelihood.problem.names,
            x.tolist(),
            sds,
            apparatus.tolist(),
            most,
            of_noise.tolist(),
            strict=True,
        )
    )
    residuals = likelihood.residuals(x)
    optimum = Fit(linear.dot(residuals, residuals), x, residuals, posterior.jacobian)
    # Windows and sizes are those of these values; the test is that of the likeliest ones.
    shown = replace(_tested(likelihood, x, slopes, curves), p=tested.p, repeats=tested.repeats)
    if shown.describes:  # the likeliest curve alone is far off
        shown = tested
    return Identification(optimum, posterior, slopes, estimates, {}, shown)


def _weighed(likelihood: Likelihood, optimum: Fit) -> tuple[Likelihood, Fit]:
    """Return likelihood and optimum where misfit widens the noise, but not known values.

    With chi-square counted over the dispersion s^2, known values keep their standard deviations if
    their rows are multiplied by s.
    """
    weighed = likelihood
    for _ in range(WEIGHINGS if likelihood.prior.index else 0):
        found = likelihood.posterior(optimum.x, likelihood.slopes(optimum.x))
        weighed = replace(likelihood, prior=likelihood.prior.over(math.sqrt(found.dispersion)))
        optimum = weighed.descend(optimum.x)
    return weighed, optimum


def _tested(
    likelihood: Likelihood, x: FloatArray, slopes: FloatArray, curves: FloatArray
) -> Goodness:
    """Test a fit against the noise, with all that few repeats may hide."""
    cautious = likelihood.cautious
    return goodness_of_fit(cautious, cautious.posterior(x, slopes), curves)


def _around(
    likelihood: Likelihood, optimum: Fit, posterior: Posterior, with_profiles: bool
) -> tuple[tuple[Estimate, ...], dict[str, Profile], Fit]:
    """Return estimates and profiles about an optimum, and the lowest point met on the way."""
    dispersion = posterior.dispersion
    # A parameter that rests at a limit may leave it when another moves: no parabola tells that.
    inside = not any(limit_of(v) for v in optimum.x)
    lowest = optimum
    moved = moves(likelihood, optimum.x)
    J = posterior.jacobian[: posterior.residuals.size]
    ends = _ends_to_pass(likelihood, optimum.x)
    assumed = following_from_the_model(likelihood.problem, likelihood.prior.index)
    estimates = []
    profiles = {}
    for i, (name, x) in enumerate(zip(likelihood.problem.names, optimum.x.tolist(), strict=True)):
        # A parameter that rests at a limit does not move with the others.
        free = [k for k, v in enumerate(optimum.x) if k == i or not limit_of(v)]
        at = free.index(i)
        # Chi-square rises by the covariance without errors that it does not weigh.
        covariance = replace(posterior, hidden=None).covariance(free)
        wider = float(posterior.widening(free)[at])
        sd = float(np.sqrt(wider * covariance[at, at]))
        rise = dispersion * wider
        follow = np.zeros(optimum.x.size)
        follow[free] = covariance[:, at] / covariance[at, at]
        plain = float(np.sqrt(posterior.covariance(free, 1.0)[at, at]))
        straight = inside and _parabolic(likelihood, optimum, i, follow, sd, rise)
        if straight or not with_profiles:
            noise, wide = (Interval(*interval(x, s)) for s in (plain, sd))
            method = LINEAR
        else:
            profile, end = profile_of(likelihood.descend, optimum, i, follow, sd, rise)
            profiles[name] = profile
            lowest = min(lowest, end, key=lambda o: o.chi2)
            noise, wide = profile.interval(wider), profile.interval(rise)
            method = PROFILE
        more, most = moved.of_parameters(likelihood, covariance / dispersion, J[:, free])
        reach = max(wide.high - x, x - wide.low)
        others = J[:, [k for k in ends if k != i]]
        away = BEYOND * linear.product(covariance, J[:, free].T, others) / dispersion
        tied = bool(np.any(np.abs(away[at]) > reach))
        those = [free.index(k) for k in assumed if k in free]
        estimates.append(
            Estimate(
                name=name,
                x=x,
                sd=sd,
                apparatus=float(more[at]),
                most=most[at],
                noise=noise,
                interval=wide,
                method=method,
                bound=limit_of(x),
                tied=tied,
                one_rate=follows_with(at, those, covariance, reach),
            )
        )
    return tuple(estimates), profiles, lowest


def _ends_to_pass(likelihood: Likelihood, x: FloatArray) -> list[int]:
    """Return the parameters at a limit beyond which they may lie: no number goes below 0."""
    lower = likelihood.problem.lower
    ends = [(k, limit_of(value)) for k, value in enumerate(x)]
    return [k for k, end in ends if end == "upper" or (end == "lower" and lower[k] != 0.0)]


def _parabolic(
    likelihood: Likelihood,
    optimum: Fit,
    i: int,
    follow: FloatArray,
    sd: float,
    dispersion: float,
) -> bool:
    """Tell whether chi-square follows its parabola to the ends of a narrow interval."""
    reach = QUANTILE * sd
    if 2.0 * reach > DETERMINED or not reach < optimum.x[i] < 1.0 - reach:
        return False
    for side in (-reach, reach):
        there = optimum.x + side * follow
        if np.any(there < 0.0) or np.any(there > 1.0):
            return False
        rise = (likelihood.chi2(there) - optimum.chi2) / (QUANTILE**2 * dispersion)
        if abs(rise - 1.0) > PARABOLIC:
            return False
    return True
