"""What the data determine: intervals of parameters from the likelihood, and the verdict in words.

Near its least value chi-square is a parabola of curvature H = J^T J, J = d whitened curve / d
parameter; parameters are counted in distances of their limits. Limits are knowledge as well: they
stand as a uniform distribution of variance 1/12, so that the covariance is (H + 12 I)^-1. Known
values are rows (x - value) / sd of the residuals, and of J.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.estimate.likelihood import ENOUGH, Likelihood, Optimum, fit
from pyrofit.estimate.profile import QUANTILE, Interval, Profile, profile_of
from pyrofit.solver.arrays import FloatArray

DETERMINED = 0.20
WEAKLY = 0.50
"""Widest 95 % intervals of a determined, of a weakly determined parameter [limits' distance]."""
AT_BOUND = 0.005
"""An estimate this near to a limit is at it."""
PARABOLIC = 0.2
"""Departure of chi-square from its parabola that is tolerated at the ends of an interval."""
WEIGHINGS = 3
"""How often known values are weighed against a misfit that they change."""
RESTARTS = 3
"""How often a lower chi-square found by a profile starts the analysis again."""


@dataclass(frozen=True)
class Estimate:
    """What the data say about one parameter, in distances of its limits.

    Parameters
    ----------
    x
        Estimate.
    sd
        Standard deviation of the parabola, times the inflation.
    noise
        Interval if the noise were all that keeps model and data apart.
    interval
        The same with chi-square divided by its value per degree of freedom, where that exceeds 1.
    method
        'linear', of the parabola, or 'profile'.
    bound
        'lower' or 'upper' where the estimate is at a limit, else empty.
    """

    name: str
    x: float
    sd: float
    noise: Interval
    interval: Interval
    method: str
    bound: str

    @property
    def verdict(self) -> str:
        """Whether the data determine it, in words."""
        return verdict(self.interval.width, self.bound)


def verdict(width: float, bound: str) -> str:
    """Say whether the data determine a parameter, from the width of its interval.

    At a bound a narrow interval is the limit's doing: the parameter is not called determined.

    >>> verdict(0.2, ""), verdict(0.2, "lower"), verdict(0.9, "upper")
    ('determined', 'at its lower bound', 'undetermined, at its upper bound')
    """
    if width > WEAKLY:
        return f"undetermined, at its {bound} bound" if bound else "undetermined"
    if bound:
        return f"at its {bound} bound"
    return "determined" if width <= DETERMINED else "weakly determined"


@dataclass(frozen=True, eq=False)
class Identification:
    """The analysis: optimum, derivatives there, estimates, profiles.

    ``slopes`` are d curve / d parameter in the unit of each channel, (points, parameters);
    ``jacobian`` are the same whitened, then the rows of what is known.
    """

    optimum: Optimum
    chi2: float
    """Of the channels, without what is known."""
    inflation: float
    slopes: FloatArray
    jacobian: FloatArray
    estimates: tuple[Estimate, ...]
    profiles: dict[str, Profile]

    @property
    def correlation(self) -> FloatArray:
        """Correlation of the estimates, shape (parameters, parameters).

        What rests at a limit does not move with the others.
        """
        free = [k for k, v in enumerate(self.optimum.x) if not _bound(v)]
        covariance = covariance_of(self.jacobian[:, free], self.inflation)
        sd = np.sqrt(np.diag(covariance))
        found = np.eye(self.optimum.x.size)
        found[np.ix_(free, free)] = covariance / np.outer(sd, sd)
        return found

    def modes(self) -> tuple[FloatArray, FloatArray]:
        """Return singular values of the Jacobian and, by column, the directions they belong to.

        A combination of parameters whose value is s has the standard deviation 1/s. The largest
        component of a direction is positive.
        """
        _, values, rows = np.linalg.svd(self.jacobian, full_matrices=False)
        largest = rows[np.arange(len(rows)), np.argmax(np.abs(rows), axis=1)]
        return values, (rows * np.sign(largest)[:, None]).T


def covariance_of(jacobian: FloatArray, inflation: float) -> FloatArray:
    """Return (J^T J / inflation^2 + 12 I)^-1."""
    curvature = jacobian.T @ jacobian / inflation**2
    return np.asarray(np.linalg.inv(curvature + 12.0 * np.eye(len(curvature))))


def identify(likelihood: Likelihood, starts: Sequence[FloatArray]) -> Identification:
    """Find the least chi-square from scaled starts, and how far each parameter may be from it."""
    likelihood, optimum = _weighed(likelihood, fit(likelihood, starts))
    for _ in range(RESTARTS):
        found, lowest = _around(likelihood, optimum)
        if lowest.chi2 >= optimum.chi2 - 10.0 * ENOUGH:
            break
        optimum = likelihood.descend(lowest.x)
    return found


def _weighed(likelihood: Likelihood, optimum: Optimum) -> tuple[Likelihood, Optimum]:
    """Return likelihood and optimum where misfit widens the noise, but not what is known.

    With chi-square counted over s^2, s the inflation, known values keep their standard deviations
    if their rows are multiplied by s.
    """
    weighed = likelihood
    for _ in range(WEIGHINGS if likelihood.prior.index else 0):
        s = _inflation(weighed, _of_channels(weighed, optimum))
        weighed = replace(likelihood, prior=likelihood.prior.over(s))
        optimum = weighed.descend(optimum.x)
    return weighed, optimum


def _of_channels(likelihood: Likelihood, optimum: Optimum) -> float:
    """Return chi-square without what is known."""
    known = likelihood.prior.residuals(likelihood.values(optimum.x)[None])[0]
    return optimum.chi2 - float(known @ known)


def _inflation(likelihood: Likelihood, chi2: float) -> float:
    """Return the root of chi-square per degree of freedom, 1 at least."""
    return float(np.sqrt(max(1.0, chi2 / likelihood.freedom)))


def _around(likelihood: Likelihood, optimum: Optimum) -> tuple[Identification, Optimum]:
    """Return the analysis about an optimum, and the lowest point met on the way."""
    slopes = likelihood.slopes(optimum.x)
    jacobian = likelihood.with_known(slopes)
    chi2 = _of_channels(likelihood, optimum)
    inflation = _inflation(likelihood, chi2)
    # A parameter that rests at a limit may leave it when another moves: no parabola tells that.
    inside = not any(_bound(v) for v in optimum.x)
    lowest = optimum
    estimates = []
    profiles = {}
    for i, name in enumerate(likelihood.problem.names):
        bound = _bound(optimum.x[i])
        # What rests at a limit does not move with the others.
        free = [k for k, v in enumerate(optimum.x) if k == i or not _bound(v)]
        at = free.index(i)
        covariance = covariance_of(jacobian[:, free], inflation)
        sd = float(np.sqrt(covariance[at, at]))
        follow = np.zeros(optimum.x.size)
        follow[free] = covariance[:, at] / covariance[at, at]
        plain = float(np.sqrt(covariance_of(jacobian[:, free], 1.0)[at, at]))
        if inside and _parabolic(likelihood, optimum, i, follow, sd, inflation):
            noise, interval = (_linear(optimum.x[i], s) for s in (plain, sd))
            method = "linear"
        else:
            profile, end = profile_of(likelihood, optimum, i, follow, sd, inflation)
            profiles[name] = profile
            lowest = min(lowest, end, key=lambda o: o.chi2)
            noise, interval = profile.interval(1.0), profile.interval(inflation)
            method = "profile"
        estimates.append(Estimate(name, float(optimum.x[i]), sd, noise, interval, method, bound))
    found = Identification(optimum, chi2, inflation, slopes, jacobian, tuple(estimates), profiles)
    return found, lowest


def _bound(x: float) -> str:
    return "lower" if x <= AT_BOUND else "upper" if x >= 1.0 - AT_BOUND else ""


def _linear(x: float, sd: float) -> Interval:
    return Interval(float(x - QUANTILE * sd), float(x + QUANTILE * sd))


def _parabolic(
    likelihood: Likelihood,
    optimum: Optimum,
    i: int,
    follow: FloatArray,
    sd: float,
    inflation: float,
) -> bool:
    """Tell whether chi-square follows its parabola to the ends of a narrow interval."""
    reach = QUANTILE * sd
    if 2.0 * reach > DETERMINED or not reach < optimum.x[i] < 1.0 - reach:
        return False
    for side in (-reach, reach):
        there = optimum.x + side * follow
        if np.any(there < 0.0) or np.any(there > 1.0):
            return False
        rise = (likelihood.chi2(there) - optimum.chi2) / (QUANTILE * inflation) ** 2
        if abs(rise - 1.0) > PARABOLIC:
            return False
    return True
