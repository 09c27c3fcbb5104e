"""Curves at requested times from the values of runs at their steps."""

from typing import NamedTuple

from pyrofit.compiled.jit import inner, loop
from pyrofit.solver.kernels.trace import BURNT, KINK, POWER, PROBES, RATE, RELEASED, STEPS, TIME

JUMP_K = 20.0
"""A smooth temperature bends by far less within a step."""


class Piece(NamedTuple):
    """A column of a trace from one step to the next; behind the last one it is constant."""

    n: int
    """The step it begins with."""
    h: float
    """Its length [s]."""
    low: float
    high: float
    slope_low: float
    slope_high: float


@inner
def slope_from(time, value, kink, n, last):
    """Return dvalue/dt at the beginning of a piece; a kink there hides the step before."""
    if kink[n] == 1.0:
        return (value[n + 1] - value[n]) / (time[n + 1] - time[n])
    return slope_at(time, value, n, last)


@inner
def slope_to(time, value, kink, n, last):
    """Return dvalue/dt at the end of a piece; a kink there hides the step behind."""
    if kink[n] == 0.0 or n == last:
        return slope_at(time, value, n, last)
    h = time[n] - time[n - 1]
    rise = (value[n] - value[n - 1]) / h
    if kink[n - 1] == 1.0:
        return rise
    h_before = time[n - 1] - time[n - 2]
    return rise + h / (h + h_before) * (rise - (value[n - 1] - value[n - 2]) / h_before)


@inner
def slope_at(time, value, n, last):
    """Return dvalue/dt at a step from the parabola through three neighbours."""
    if n == 0:
        return (value[1] - value[0]) / (time[1] - time[0])
    before = (value[n] - value[n - 1]) / (time[n] - time[n - 1])
    if n == last:
        return before
    h0, h1 = time[n] - time[n - 1], time[n + 1] - time[n]
    return (h1 * before + h0 * ((value[n + 1] - value[n]) / h1)) / (h0 + h1)


@inner
def beside_jumps(slope, mean, n, time):
    """Return the slope at an end of a piece, its mean slope if the next piece jumps.

    A place inside jumps as its cell leaves the grid, within a step as short as it likes. The
    parabola through a long step and a short one then has a slope that is none of the long one's.
    """
    return mean if abs(slope - mean) * (time[n + 1] - time[n]) > JUMP_K else slope


@inner
def piece_from(rows, last, column, n):
    """Return the piece that begins with step n.

    The columns RELEASED and BURNT have their rates as slopes, all others those of parabolas.
    """
    time, value = rows[:, TIME], rows[:, column]
    if n == last:
        return Piece(n, 1.0, value[n], value[n], 0.0, 0.0)
    if column == RELEASED:
        low, high = rows[n, RATE], rows[n + 1, RATE]
    elif column == BURNT:
        low, high = rows[n, POWER], rows[n + 1, POWER]
    else:
        kink = rows[:, KINK]
        low = slope_from(time, value, kink, n, last)
        high = slope_to(time, value, kink, n + 1, last)
        if column >= PROBES:
            mean = (value[n + 1] - value[n]) / (time[n + 1] - time[n])
            low, high = beside_jumps(low, mean, n, time), beside_jumps(high, mean, n, time)
    return Piece(n, time[n + 1] - time[n], value[n], value[n + 1], low, high)


@inner
def piece_at(rows, last, column, piece, at):
    """Return the piece in which a time lies that is not before the given one."""
    n = piece.n
    while n < last and rows[n + 1, TIME] < at:
        n += 1
    return piece if n == piece.n else piece_from(rows, last, column, n)


@inner
def part_at(rows, piece, at):
    """Return which part of a piece has passed at a time; before the start, none."""
    return max(at - rows[piece.n, TIME], 0.0) / piece.h


@inner
def value_at(rows, piece, at):
    """Return the cubic of a piece at a time."""
    s = part_at(rows, piece, at)
    low, high, h = piece.low, piece.high, piece.h
    bend = h * s * (1.0 - s) * ((1.0 - s) * piece.slope_low - s * piece.slope_high)
    return low + s * s * (3.0 - 2.0 * s) * (high - low) + bend


@inner
def rate_at(rows, piece, at):
    """Return its derivative there."""
    s = part_at(rows, piece, at)
    mean = 6.0 * s * (1.0 - s) * (piece.high - piece.low) / piece.h
    return mean + (
        (1.0 - s) * (1.0 - 3.0 * s) * piece.slope_low + s * (3.0 * s - 2.0) * piece.slope_high
    )


@loop
def sampled(rows, last, column, at, out):
    """Write a column at ascending times."""
    piece = piece_from(rows, last, column, 0)
    for b in range(at.size):
        piece = piece_at(rows, last, column, piece, at[b])
        out[b] = value_at(rows, piece, at[b])


@loop
def sampled_rate(rows, last, column, at, out):
    """Write the time derivative of column RELEASED or BURNT; after the end it is zero."""
    piece = piece_from(rows, last, column, 0)
    for b in range(at.size):
        piece = piece_at(rows, last, column, piece, at[b])
        out[b] = rate_at(rows, piece, at[b])


@loop
def averaged_rate(rows, last, column, half, at, out):
    """Write its mean rate from ``half`` [s] before each time to as long after it.

    Nothing is released before 0.
    """
    piece = ahead = piece_from(rows, last, column, 0)
    end, gone = -1.0, 0.0
    for b in range(at.size):
        begin = max(at[b] - half, 0.0)
        before = gone
        if begin != end:
            piece = piece_at(rows, last, column, piece, begin)
            before = value_at(rows, piece, begin)
        end = at[b] + half
        ahead = piece_at(rows, last, column, ahead, end)
        gone = value_at(rows, ahead, end)
        out[b] = (gone - before) / max(end - begin, 1e-9)


@loop
def sample(trace, outcome, asked, at, out):
    """Write all that is asked of the runs of a trace, one signal behind the other.

    ``trace`` has shape (steps, columns, runs); ``at``, times [s], and ``out`` (runs, points).
    """
    for lane in range(at.shape[0]):
        rows, last = trace[:, :, lane], int(outcome[lane, STEPS])
        for a in range(asked.column.size):
            begin, end = asked.begin[a], asked.begin[a + 1]
            times, curve = at[lane, begin:end], out[lane, begin:end]
            column = asked.column[a]
            if column not in (RATE, POWER):
                sampled(rows, last, column, times, curve)
                continue
            summed = RELEASED if column == RATE else BURNT
            if asked.half[a] == 0.0:
                sampled_rate(rows, last, summed, times, curve)
            else:
                averaged_rate(rows, last, summed, asked.half[a], times, curve)
