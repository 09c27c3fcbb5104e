"""Whether ensembles of a sampler agree, and how many independent draws they are worth.

Rank-normalised split R-hat: Gelman and Rubin (1992, doi 10.1214/ss/1177011136) as improved by
Vehtari et al. (2021, doi 10.1214/20-BA1221). Effective sample size from the integrated
autocorrelation time of Goodman and Weare (2010, doi 10.2140/camcos.2010.5.65), as emcee estimates
it.
"""

import numpy as np

from pyrofit.solver.arrays import FloatArray

RHAT = 1.05
"""Largest R-hat of ensembles that agree."""
ESS = 200.0
"""Least effective sample size: the mean is then known to 7 % of the standard deviation."""
ENOUGH_TIMES = 20.0
"""Least length in autocorrelation times from which on these are believed."""


def rhat(samples: FloatArray) -> float:
    """Return the rank-normalised split R-hat of one parameter, the larger of bulk and tails.

    With the groups' mean variance W and the variance B of their means, sqrt(1 + B/W).

    Parameters
    ----------
    samples
        Shape (ensembles, steps, walkers); the walkers of an ensemble depend on each other, so an
        ensemble counts as one chain.

    >>> apart = np.stack([np.arange(8.0).reshape(4, 2), np.arange(8.0).reshape(4, 2) + 100.0])
    >>> rhat(apart) > 2.0
    True
    """
    half = samples.shape[1] // 2
    halves = np.concatenate([samples[:, :half], samples[:, half : 2 * half]])
    groups = halves.reshape(len(halves), -1)
    return max(_of_groups(groups), _of_groups(np.abs(groups - np.median(groups))))


def _of_groups(groups: FloatArray) -> float:
    from scipy.stats import norm, rankdata  # half a second that other steps save

    ranks = rankdata(groups).reshape(groups.shape)
    scores = norm.ppf((ranks - 0.375) / (ranks.size + 0.25))
    within = float(np.mean(np.var(scores, axis=1, ddof=1)))
    between = float(np.var(np.mean(scores, axis=1), ddof=1))
    return float(np.sqrt(1.0 + between / within)) if within > 0.0 else 1.0


def autocorrelation_times(samples: FloatArray) -> FloatArray:
    """Return the integrated autocorrelation time of each parameter in steps.

    ``samples`` has the shape (ensembles, steps, walkers, parameters). Where a walker has never
    moved, the time is unknown and at least the number of steps, which is returned.
    """
    from emcee.autocorr import integrated_time

    together = np.concatenate(list(samples), axis=1)
    with np.errstate(invalid="ignore"):
        times = np.asarray(integrated_time(together, quiet=True, tol=0), dtype=np.float64)
    return np.maximum(np.where(np.isnan(times), len(together), times), 1.0)
