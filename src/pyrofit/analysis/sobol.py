"""Variance-based sensitivity: Sobol's indices of first and total order, with intervals.

With the variance V of an output, and E and V over some inputs, the others held,

    first_i = V_i(E_~i(y | x_i)) / V,    total_i = E_~i(V_i(y | x_~i)) / V.

first_i is the share of the variance that input i makes alone, total_i that with its part in all
combinations (Sobol 2001, doi 10.1016/S0378-4754(00)00270-6). SciPy estimates both (Saltelli et al.
2010, doi 10.1016/j.cpc.2009.09.018). Its bootstrap takes no seed; the one here does.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

RESAMPLES = 200
"""Resamples of the bootstrap."""
LEVEL = 0.95
"""Share of them within an interval."""


@dataclass(frozen=True, eq=False)
class Indices:
    """Indices of first and total order and their intervals, shape (outputs, inputs) each.

    They are no numbers where an output does not vary.
    """

    first: FloatArray
    first_low: FloatArray
    first_high: FloatArray
    total: FloatArray
    total_low: FloatArray
    total_high: FloatArray


def design(count: int, inputs: int, seed: int) -> FloatArray:
    """Return points of the unit cube, shape (count, inputs + 2, inputs).

    Of each base point: A, B, and A with one coordinate of B after the other, from a Sobol sequence
    in twice the dimensions, shifted at random.

    Parameters
    ----------
    count
        Number of base points, a power of two.
    inputs
        Number of inputs.
    seed
        Seed of the shift.
    """
    from scipy.stats import qmc  # half a second that other commands do without

    shift = np.random.default_rng(seed).random(2 * inputs)
    both = (qmc.Sobol(2 * inputs, scramble=False).random(count) + shift) % 1.0
    A, B = both[:, :inputs], both[:, inputs:]
    points = np.repeat(A[:, None], inputs + 2, axis=1)
    points[:, 1] = B
    i = np.arange(inputs)
    points[:, i + 2, i] = B
    return points


def replace_failed(outputs: FloatArray, seed: int) -> tuple[FloatArray, int]:
    """Replace base points of which a run failed by others, drawn by the seed; return how many.

    ``outputs`` has the shape (count, inputs + 2, outputs). SciPy takes a power of two of them.
    """
    failed = ~np.isfinite(outputs).all(axis=(1, 2))
    if not failed.any() or failed.all():
        return outputs, int(failed.sum())
    whole = np.flatnonzero(~failed)
    drawn = np.random.default_rng(seed).choice(whole, int(failed.sum()))
    outputs = outputs.copy()
    outputs[failed] = outputs[drawn]
    return outputs, int(failed.sum())


def indices(outputs: FloatArray, seed: int) -> Indices:
    """Return the indices of all outputs, with bootstrap intervals.

    Parameters
    ----------
    outputs
        Shape (count, inputs + 2, outputs), at the points of `design`; finite.
    seed
        Seed of the bootstrap, in which a base point is drawn with all its runs.
    """
    from scipy.stats import sobol_indices

    count = len(outputs)
    by_run = np.moveaxis(outputs, 0, -1)
    scale = by_run.std(axis=(0, 2))
    constant = scale == 0.0
    by_run = by_run / np.where(constant, 1.0, scale)[:, None]
    found = sobol_indices(func={"f_A": by_run[0], "f_B": by_run[1], "f_AB": by_run[2:]}, n=count)
    rng = np.random.default_rng(seed)
    draws = rng.multinomial(count, np.full(count, 1.0 / count), RESAMPLES) / count
    ends = _intervals(by_run - by_run[:2].mean(axis=(0, 2))[:, None], draws)
    shape = by_run.shape[1], by_run.shape[0] - 2
    first, total = (
        np.asarray(order, float).reshape(shape) for order in (found.first_order, found.total_order)
    )
    parts = [first, *ends[0], total, *ends[1]]
    return Indices(*(_without(part, constant) for part in parts))


def _intervals(
    centred: FloatArray, draws: FloatArray
) -> tuple[tuple[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]:
    """Return the ends of the intervals of both orders, shape (outputs, inputs) each.

    ``draws`` are the weights of the base points in every resample, shape (resamples, count): a
    mean over a resample is a product with them.
    """
    f_A, f_B = centred[0], centred[1]
    mean = linear.product(0.5 * (f_A + f_B), draws.T)
    variance = linear.product(0.5 * (f_A**2 + f_B**2), draws.T) - mean**2
    variance = np.where(variance > 0.0, variance, 1.0)
    ends = np.empty((2, 2, f_A.shape[0], len(centred) - 2))
    for i, f_AB in enumerate(centred[2:]):
        first = linear.product(f_B * (f_AB - f_A), draws.T) / variance
        total = linear.product(0.5 * (f_A - f_AB) ** 2, draws.T) / variance
        tails = 0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL
        ends[0, :, :, i] = np.quantile(first, tails, axis=1)
        ends[1, :, :, i] = np.quantile(total, tails, axis=1)
    return (ends[0, 0], ends[0, 1]), (ends[1, 0], ends[1, 1])


def _without(part: FloatArray, constant: NDArray[np.bool_]) -> FloatArray:
    return np.where(constant[:, None], np.nan, part)
