"""Scores as MaCFP computes them: normalised root mean squares of mean curves."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from pyrofit.cost.distances import root_mean_square
from pyrofit.errors import DataError
from pyrofit.solver.arrays import FloatArray


class Mean(NamedTuple):
    """The mean of repeats where all of them are measured, and their scatter, shape (n,).

    Parameters
    ----------
    time_s, value
        Times of the first repeat, and the mean.
    sd
        Standard deviation of a single repeat; NaN of one test alone.
    repeats
        Number of repeats.
    """

    time_s: FloatArray
    value: FloatArray
    sd: FloatArray
    repeats: int

    @property
    def range(self) -> float:
        """Largest less smallest value of the mean: it divides all errors."""
        return float(np.ptp(self.value))

    @property
    def floor(self) -> float:
        """Scatter of a single repeat, normalised: rms over time of its standard deviation.

        NaN of one test alone.
        """
        return root_mean_square(self.sd) / self.range


def mean_of(repeats: Sequence[tuple[FloatArray, FloatArray]]) -> Mean:
    """Return the mean of records (times, values) where all of them overlap.

    Raises
    ------
    DataError
        The records overlap at fewer than 3 times, or their mean is constant.

    Examples
    --------
    >>> t = np.arange(4.0)
    >>> mean = mean_of([(t, t), (t, t + 2.0)])
    >>> mean.value.tolist(), round(mean.floor, 3)
    ([1.0, 2.0, 3.0, 4.0], 0.471)
    """
    first = max(t[0] for t, _ in repeats)
    last = min(t[-1] for t, _ in repeats)
    time = repeats[0][0]
    time = time[(time >= first) & (time <= last)]
    if time.size < 3:
        raise DataError(
            f"the repeats have {time.size} times in common; each score needs 3. Correct `delay_s` "
            "and `until_s`, or list the records as tests of their own"
        )
    values = np.array([np.interp(time, t, y) for t, y in repeats])
    count = len(repeats)
    sd = values.std(axis=0, ddof=1) if count > 1 else np.full(time.size, np.nan)
    mean = Mean(time, values.mean(axis=0), sd, count)
    if not mean.range > 0.0:
        raise DataError("the mean of the repeats is constant; errors cannot be normalised by it")
    return mean


def mean_at_times(mean: Mean, curves: Sequence[tuple[FloatArray, FloatArray]]) -> FloatArray:
    """Return the mean of curves (times, values) at the times of a mean; NaN where one has none."""
    every = [np.interp(mean.time_s, t, y, left=np.nan, right=np.nan) for t, y in curves]
    return np.asarray(np.mean(every, axis=0))


def nrms(mean: Mean, predicted: FloatArray) -> float:
    """Return rms(mean measured - mean predicted) / (max - min of mean measured).

    This is the score of MaCFP-3, over the times of the mean at which ``predicted``, shape (n,), is
    a number; NaN without such a time.

    Examples
    --------
    >>> t = np.arange(5.0)
    >>> mean = mean_of([(t, t)])
    >>> nrms(mean, t + 1.0), nrms(mean, np.where(t < 2.0, t + 2.0, np.nan))
    (0.25, 0.5)
    """
    kept = np.isfinite(predicted)
    if not kept.any():
        return float("nan")
    return root_mean_square((predicted - mean.value)[kept]) / mean.range
