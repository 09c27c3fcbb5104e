"""The arrays of heated samples: programmes, state, and output."""

from typing import NamedTuple

import numpy as np

from pyrofit.compiled.jit import making
from pyrofit.solver.arrays import FloatArray, Number
from pyrofit.solver.kernels.lanes import in_lanes
from pyrofit.solver.kernels.work import Room, make_room


class Program(NamedTuple):
    """The temperature programme of one experiment."""

    time: FloatArray
    """[s], shape (points,)."""
    temperature: FloatArray
    """[K], shape (points,)."""
    lag: Number
    """By which the sample is behind [K]."""


class Sample(NamedTuple):
    """The state of the sample, and room to work."""

    m: FloatArray
    """Masses of the components over the initial mass [-], shape (components, 1)."""
    m_new: FloatArray
    formed: FloatArray
    """Mass ever present, the reference of the reaction order."""
    k: FloatArray
    """k_j [1/s], shape (reactions,)."""
    room: Room


class Gas(NamedTuple):
    """The quantities of a sample wanted beside its mass, and the burning of its gas."""

    detailed: bool
    """Whether masses and rates by component and reaction are wanted."""
    burns: bool
    """Whether the heat release is wanted."""
    heat: FloatArray
    """Heat of combustion [J per kg of reactant], shape (reactions,)."""
    response: Number
    """Time constant of its record [s]."""


class Written(NamedTuple):
    """The output of a sample, the points first."""

    mass: FloatArray
    rate: FloatArray
    masses: FloatArray
    """By component, shape (points, components)."""
    rates: FloatArray
    """By reaction, shape (points, reactions)."""
    release: FloatArray


@making
def allocate(lanes, components, reactions, points, detailed):
    """Return arrays for the output of the samples, the last axis the lanes."""
    return Written(
        np.empty((points, lanes)),
        np.empty((points, lanes)),
        np.empty((detailed, components, lanes)),
        np.empty((detailed, reactions, lanes)),
        np.empty((detailed, lanes)),
    )


@making
def of_points(width, written, part):
    """Return some of the points, with the lanes as numbers."""
    return Written(
        in_lanes(width, written.mass[part]),
        in_lanes(width, written.rate[part]),
        in_lanes(width, written.masses[part]),
        in_lanes(width, written.rates[part]),
        in_lanes(width, written.release[part]),
    )


@making
def sample_of(width, masses, rates):
    """Return the sample that these arrays hold."""
    numbers = in_lanes(width, masses)
    room = make_room(width, rates.shape[0])
    return Sample(numbers[0], numbers[1], numbers[2], in_lanes(width, rates), room)
