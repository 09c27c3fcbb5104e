"""Noise that depends on the simulated curve: of signals that jump or are steep over temperature."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from pyrofit.estimate.apparatus import apparatus_error
from pyrofit.estimate.between_ends import with_records
from pyrofit.estimate.channel_noise import noise_of
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import FloatArray


def with_noise_of_curves(likelihood: Likelihood, sets: Iterable[FloatArray]) -> Likelihood:
    """Return the likelihood with the noise that depends on the curve, about that of a set.

    A smooth curve does not follow a jump, as a heat release rate has at ignition: the noise then
    looks larger than it is. The noise about the simulated curve is used if its BIC is lower. An
    error of the temperature moves the simulated curve; a smooth one is less steep.

    Parameters
    ----------
    likelihood
        With the noise of every channel estimated about a smooth curve.
    sets
        Known sets that fit well, as fractions of the search range, shape (parameters,) each. The
        one of the lowest chi-square counts.
    """
    problem = likelihood.problem
    jumps = [problem.runs[name].experiment.jumps for name, _, _ in problem.picks]
    heated = ["temperature" in noise.floors for noise in likelihood.noise]
    known = list(sets) if any(jumps) or any(heated) else []
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
        elif heated[k]:
            noise[k] = _moved(problem, k, noise[k], curve)
    if any(jumps):
        noise = list(with_records(problem, noise, parts))
    return replace(likelihood, noise=tuple(noise))


def _moved(problem: Problem, channel: int, noise: NoiseModel, curve: FloatArray) -> NoiseModel:
    """Return the noise with the errors of the apparatus that a simulated curve has."""
    name, measured, _ = problem.picks[channel]
    experiment = problem.runs[name].experiment
    signal = experiment.signals[measured]
    own = apparatus_error(
        experiment.quantity(measured),
        problem.cost.terms[channel][1].target.time_s,
        curve,
        problem.temperature_K(channel),
        signal.timing_s,
        signal.lasting_sd,
    )
    if own is None or noise.modes is None:
        return noise
    of_repeats = noise.modes[:, noise.modes.shape[1] - noise.between :]
    return replace(noise, modes=np.column_stack([own.modes, of_repeats]))
