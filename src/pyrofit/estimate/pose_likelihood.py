"""Poses the likelihood of a study's parameters, for all steps and for the Python interface.

All that decides chi-square comes together here: the problem, known values, and the noise. The noise
of a channel has errors that follow the simulated curve, and the scatter between repeats.
"""

from collections.abc import Iterable, Mapping

import numpy as np

from pyrofit.config import Study
from pyrofit.estimate.likelihood import Likelihood, likelihood_of
from pyrofit.estimate.noise_of_curves import with_noise_of_curves
from pyrofit.estimate.pose import Estimation, pose
from pyrofit.estimate.prior import prior_of
from pyrofit.estimate.targets import Measurements
from pyrofit.solver.arrays import FloatArray


def pose_likelihood(
    study: Study,
    estimation: Estimation,
    measurements: Measurements,
    fixed: Mapping[str, float],
    fits: Iterable[Mapping[str, float]] = (),
    tolerant: bool = False,
) -> Likelihood:
    """Return the likelihood, with known values and the noise of every channel.

    Parameters
    ----------
    study, estimation, measurements, fixed
        As for `pose`; the terms are the channels, each once.
    fits
        Sets that fit well, SI units by name; `fixed` holds what a set leaves out. Signals that
        jump, or are recorded against temperature, have their noise about the best of them. Read
        only if there are such signals.
    tolerant
        Whether the noise includes the usual discrepancy of models, as that of the diagnosis does:
        it searches effects for what exceeds it. All other steps test the model without it.

    Raises
    ------
    DataError
        A channel is too short to show its noise.
    """
    problem = pose(study, estimation, measurements, fixed)
    likelihood = likelihood_of(problem, prior_of(study, problem), tolerant)

    def scaled(values: Mapping[str, float]) -> FloatArray:
        return likelihood.scaled(np.array([{**fixed, **values}[name] for name in problem.names]))

    return with_noise_of_curves(likelihood, map(scaled, fits))
