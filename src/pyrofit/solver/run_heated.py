"""Runs of the kernel of heated samples: parameter sets side by side, and their results."""

from functools import partial
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pyrofit.solver import arrays
from pyrofit.solver.arrays import FloatArray, IntArray
from pyrofit.solver.run import FEW, LANES, mapped, split


class Programs(NamedTuple):
    """Temperature programmes, one behind the other, as the kernel takes them."""

    time_s: FloatArray
    temperature_K: FloatArray
    begins: IntArray
    """Where each begins, and where the last one ends, shape (programs + 1,)."""
    wanted: NDArray[np.bool_]
    """Whether the parts of the heat flow, and the heat release, are wanted: (programs, 2)."""


class Heated(NamedTuple):
    """The results of heated samples; the last two axes are sets and points.

    The last three have no values where no programme wants them.
    """

    mass: FloatArray
    """Over initial mass [-], shape (sets, points)."""
    rate: FloatArray
    """Loss of that [1/s], shape (sets, points)."""
    masses: FloatArray
    """By component, shape (components, sets, points)."""
    rates: FloatArray
    """Consumed by each reaction [1/s], shape (reactions, sets, points)."""
    release: FloatArray
    """Heat of the burning gas [W/kg], shape (sets, points)."""


def heat(
    programs: Programs,
    lags: FloatArray,
    start: FloatArray,
    network: arrays.Network,
    step: FloatArray,
    burning: tuple[FloatArray, FloatArray],
) -> Heated:
    """Run heated samples; side by side run sets of one step.

    ``burning`` holds the heat of combustion [J per kg of reactant], shape (reactions, sets), and
    the time constants of its record [s], shape (programs, sets).
    """
    from pyrofit.solver.kernels.tga import tga

    sets, points = start.shape[-1], programs.time_s.size
    asked = points if programs.wanted.any() else 0
    counts = len(start), network.reactant.size
    found = Heated(
        np.empty((sets, points)),
        np.empty((sets, points)),
        np.empty((counts[0], sets, asked)),
        np.empty((counts[1], sets, asked)),
        np.empty((sets, asked)),
    )
    for longest_rise in sorted(set(step.tolist())):
        order = np.flatnonzero(step == longest_rise)
        for group in _groups((lags, start, network, burning), order, sets):
            *parts, heats = group.parts
            in_lanes = tga((0,) * group.width, programs, *parts, longest_rise, heats)
            for all_sets, lanes in zip(found, in_lanes, strict=True):
                # From (points, ..., lanes) to (..., sets, points).
                turned = lanes.transpose(*range(1, lanes.ndim), 0)
                all_sets[..., group.sets, :] = turned[..., : group.sets.size, :]
    return found


class _Group(NamedTuple):
    """Sets that run side by side, in how many lanes, and the arrays of these lanes."""

    sets: IntArray
    width: int
    parts: Any


def _groups(parts: Any, order: IntArray, sets: int) -> list[_Group]:
    """Share out sets in the order given, of as many as the last axis of the arrays has."""
    if sets == 1:
        return [_Group(order, 1, parts)]
    rest = order.size % LANES
    size = order.size - rest if rest <= FEW else order.size
    groups = []
    if size:
        # In the lanes left over the last one runs again.
        filled = np.append(order[:size], np.repeat(order[size - 1 : size], -size % LANES))
        together = mapped(lambda a: split(a, filled), parts)
        for g in range(filled.size // LANES):
            index = order[:size][g * LANES : (g + 1) * LANES]
            groups.append(_Group(index, LANES, mapped(itemgetter(g), together)))
    return groups + [
        _Group(i, 1, mapped(partial(np.take, indices=i, axis=-1), parts))
        for i in order[size:, None]
    ]
