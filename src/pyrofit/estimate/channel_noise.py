"""Noise of a channel: a signal of an experiment that is fitted."""

from pyrofit.errors import DataError
from pyrofit.estimate.noise import NoiseModel, estimate_noise
from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import FloatArray


def noise_of(
    problem: Problem, channel: int, about: FloatArray | None = None, tolerant: bool = False
) -> NoiseModel:
    """Return the noise of a channel, about a simulated curve where one is given.

    A ``tolerant`` noise includes the usual discrepancy of models, see `estimate_noise`.

    Raises
    ------
    DataError
        The channel is too short.
    """
    name, measured, _ = problem.picks[channel]
    experiment = problem.runs[name].experiment
    quantity, signal = experiment.quantity(measured), experiment.signals[measured]
    target = problem.cost.terms[channel][1].target
    try:
        return estimate_noise(
            target,
            quantity,
            signal.uncertainty_sds,
            signal.timing_s,
            about,
            temperature_K=problem.temperature_K(channel),
            drift=signal.lasting_sd,
            tolerant=tolerant,
        )
    except DataError as error:
        raise DataError(f"{name}: {error}") from None
