"""Levels at the end of heated samples that differ by more than their noise.

Records of one material at several heating rates end at one residue r in the model. Let e_i be the
mean of the last points of record i of N, and v the mean of their variances by the noise. Balances
that drift from run to run make

    s^2 = (sum (e_i - mean e)^2 + n_0 v) / (N - 1 + n_0) - v

larger than zero, where the noise counts as n_0 = 0.5 records. If the ends differ significantly,
each record has one more lasting error. It grows in proportion to time and has the standard
deviation s at the end. Otherwise the residue would be determined better than the records agree on
it. Few records tell s badly. So intervals and tests multiply it by the quantile of Student's
distribution, with N - 1 + n_0 degrees of freedom, over that of the normal one.
"""

from collections.abc import Sequence

import numpy as np
from scipy.special import chdtrc

from pyrofit.estimate.between_repeats import (
    USUAL_WEIGHT,
    student_factor,
    with_modes,
    with_repeats,
)
from pyrofit.estimate.noise import ENDS, NoiseModel
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.repeats_agree import is_held
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

LAST = 0.05
"""Part of a record whose mean is its end."""
STILL = 0.005
"""Share of the loss in the last tenth up to which a record has a level end."""
LEVEL = 0.05
"""Probability of such differences by noise, below which they count."""


def with_records(
    problem: Problem,
    noise: Sequence[NoiseModel],
    about: Sequence[FloatArray] | None = None,
) -> tuple[NoiseModel, ...]:
    """Return the noise of all channels with the scatter between records.

    That is the scatter between repeats, see `with_repeats`, and that of the ends of records at
    several rates where it is significant.
    """
    found = list(with_repeats(problem, noise, about))
    for channels in _groups(problem, found):
        caution = np.array([student_factor(len(channels) - 1 + USUAL_WEIGHT)])
        spread = _spread(problem, channels, found)
        for i in channels if spread else []:
            time = problem.cost.terms[i][1].target.time_s
            grown = spread * (time - time[0]) / (time[-1] - time[0])
            found[i] = with_modes(found[i], grown[:, None], caution, ENDS)
    return tuple(found)


def _groups(problem: Problem, noise: Sequence[NoiseModel]) -> list[list[int]]:
    """Return the channels of mass fractions of ramps that end level, by gas.

    A record with a stated uncertainty has no further errors, and repeats have their own scatter.
    """
    groups: dict[float | str, list[int]] = {}
    for i, (name, signal, _) in enumerate(problem.picks):
        experiment, temperature = problem.runs[name].experiment, problem.temperature_K(i)
        if temperature is None or experiment.repeat or "drift" not in noise[i].floors:
            continue
        if experiment.quantity(signal).scales[0] != "fraction":
            continue
        values = problem.cost.terms[i][1].target.value
        tenth = max(values.size // 10, 1)
        level = values[-tenth - 1] - values[-1] <= STILL * (values[0] - values[-1])
        if level and not is_held(temperature, values):
            groups.setdefault(getattr(experiment, "oxygen", 0.0), []).append(i)
    return [channels for channels in groups.values() if len(channels) > 1]


def _spread(problem: Problem, channels: Sequence[int], noise: Sequence[NoiseModel]) -> float:
    """Return s, 0 where it is not significant."""
    ends, variances = [], []
    for i in channels:
        values = problem.cost.terms[i][1].target.value
        weights = _last(values.size)
        ends.append(linear.dot(weights, values))
        spread = noise[i].covariance_with(weights[:, None])[:, 0]
        variances.append(linear.dot(weights, spread))
    freedom, v = len(ends) - 1, float(np.mean(variances))
    squares = freedom * float(np.var(ends, ddof=1))
    pooled = (squares + USUAL_WEIGHT * v) / (freedom + USUAL_WEIGHT)
    return float(np.sqrt(max(pooled - v, 0.0))) if chdtrc(freedom, squares / v) < LEVEL else 0.0


def _last(points: int) -> FloatArray:
    weights = np.zeros(points)
    weights[-max(round(LAST * points), 5) :] = 1.0
    return np.asarray(weights / weights.sum())
