"""Quantities given over time: flux, heat transfer coefficients, temperatures of gas and walls."""

from typing import NamedTuple

from pyrofit.compiled.jit import inner
from pyrofit.solver.arrays import (
    BACK_GAS,
    BACK_H,
    BACK_WALL,
    FLAME,
    FLUX,
    FRONT_GAS,
    FRONT_H,
    FRONT_WALL,
    TIME,
    Number,
)
from pyrofit.solver.kernels.functions import at_node
from pyrofit.solver.kernels.lanes import where
from pyrofit.solver.kernels.reactions import TINY


class Air(NamedTuple):
    """The surroundings that a side exchanges heat with, at one time."""

    h: Number
    """Constant part of the heat transfer coefficient [W/(m2 K)]."""
    gas: Number
    """[K]."""
    wall: Number
    """[K]."""


class Given(NamedTuple):
    """Everything that is given over time, at one time."""

    flux: Number
    """External [W/m2]."""
    flame: Number
    """Flux of the flame [W/m2]."""
    front: Air
    back: Air


@inner
def piece_of(t, schedule):
    """Return the piece of the schedule in which the time after t lies."""
    piece = 0.0 * t
    for p in range(1, schedule.shape[1]):
        piece = where(schedule[TIME, p] <= t, 1.0 * p, piece)
    return piece


@inner
def end_of(piece, schedule, t_end):
    """Return the end of a piece, or of the run if that is earlier [s]."""
    end = t_end
    for p in range(1, schedule.shape[1]):
        end = where(piece == p - 1.0, min(t_end, schedule[TIME, p]), end)
    return end


@inner
def jumps(t, schedule):
    """Tell whether something given jumps at t."""
    jump = t != t
    for p in range(1, schedule.shape[1]):
        jump = jump | ((schedule[TIME, p] == t) & (schedule[TIME, p - 1] == t))
    return jump


@inner
def given_at(t, piece, schedule):
    """Return the given quantities at time t, which lies on a piece of the schedule."""
    last = schedule.shape[1] - 1.0
    after = min(piece + 1.0, last)
    part = 0.0 * t
    if schedule.shape[1] > 1:
        start = at_node(schedule, TIME, piece)
        span = max(at_node(schedule, TIME, after) - start, TINY)
        part = min(max(t - start, 0.0) / span, 1.0)
    return Given(
        on_piece(schedule, FLUX, piece, after, part),
        during(piece, FLAME, schedule),
        Air(
            on_piece(schedule, FRONT_H, piece, after, part),
            on_piece(schedule, FRONT_GAS, piece, after, part),
            on_piece(schedule, FRONT_WALL, piece, after, part),
        ),
        Air(
            on_piece(schedule, BACK_H, piece, after, part),
            on_piece(schedule, BACK_GAS, piece, after, part),
            on_piece(schedule, BACK_WALL, piece, after, part),
        ),
    )


@inner
def during(piece, row, schedule):
    """Return a row's value that holds during a piece of the schedule."""
    if schedule.shape[1] == 1:
        return schedule[row, 0] + 0.0 * piece
    return at_node(schedule, row, piece)


@inner
def on_piece(schedule, row, piece, after, part):
    """Return a row's value at a part of the way from one point of the schedule to the next."""
    if schedule.shape[1] == 1:
        return schedule[row, 0] + 0.0 * part
    start = at_node(schedule, row, piece)
    return start + (at_node(schedule, row, after) - start) * part
