"""Noise of signals that jump, as a heat release rate does at ignition."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from pyrofit.estimate.between_repeats import with_repeats
from pyrofit.estimate.channel_noise import noise_of
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.solver.arrays import FloatArray


def with_noise_of_jumps(likelihood: Likelihood, sets: Iterable[FloatArray]) -> Likelihood:
    """Return the likelihood with the noise of signals that jump about a simulated curve.

    A smooth curve does not follow a jump: its noise then looks larger than it is. The curve is that
    of the set with the lowest chi-square. The new noise is used only if its BIC is lower.

    Parameters
    ----------
    likelihood
        With the noise of every channel estimated about a smooth curve.
    sets
        Known sets that fit well, as fractions of the search range, shape (parameters,) each.
    """
    problem = likelihood.problem
    jumps = [problem.runs[name].experiment.jumps for name, _, _ in problem.picks]
    known = list(sets) if any(jumps) else []
    if not known:
        return likelihood
    best = min(known, key=likelihood.chi2)
    curves = likelihood.curves(np.asarray(best))
    if curves is None:
        return likelihood
    noise = list(likelihood.noise)
    parts = likelihood.split(curves)
    for k, curve in enumerate(parts):
        if jumps[k]:
            noise[k] = min(noise[k], noise_of(problem, k, curve), key=lambda n: n.criterion)
    return replace(likelihood, noise=with_repeats(problem, noise, parts))
