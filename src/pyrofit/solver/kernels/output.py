"""Curves at requested times from what runs hold at their steps."""

from pyrofit.solver.kernels.jit import inner, loop
from pyrofit.solver.kernels.trace import RATE, RELEASED, STEPS, TIME


@inner
def find(time, last, n, at):
    """Return the last step before a time, not before step n."""
    while n < last and time[n + 1] < at:
        n += 1
    return n


@inner
def hermite(h, s, low, high, slope_low, slope_high):
    """Return the cubic with given values and slopes at both ends of a step h, at its part s."""
    bend = h * s * (1.0 - s) * ((1.0 - s) * slope_low - s * slope_high)
    return low + s * s * (3.0 - 2.0 * s) * (high - low) + bend


@inner
def slope_at(time, value, n, last):
    """Return dvalue/dt at a step from the parabola through three neighbours."""
    if last == 0:
        return 0.0
    if n == 0:
        return (value[1] - value[0]) / (time[1] - time[0])
    before = (value[n] - value[n - 1]) / (time[n] - time[n - 1])
    if n == last:
        return before
    h0, h1 = time[n] - time[n - 1], time[n + 1] - time[n]
    return (h1 * before + h0 * ((value[n + 1] - value[n]) / h1)) / (h0 + h1)


@inner
def value_at(rows, last, column, n, at):
    """Return a column at a time not before step n by cubic Hermite interpolation, held at the end.

    What was released goes with its rate, everything else with parabolas' slopes. Return also the
    last step before that time.
    """
    time, value = rows[:, TIME], rows[:, column]
    n = find(time, last, n, at)
    if at <= time[0]:
        return value[0], n
    if n == last:
        return value[last], n
    if column == RELEASED:
        low, high = rows[n, RATE], rows[n + 1, RATE]
    else:
        low = slope_at(time, value, n, last)
        high = slope_at(time, value, n + 1, last)
    h = time[n + 1] - time[n]
    return hermite(h, (at - time[n]) / h, value[n], value[n + 1], low, high), n


@loop
def sampled(rows, last, column, at, out):
    """Write a column at ascending times."""
    n = 0
    for b in range(at.size):
        out[b], n = value_at(rows, last, column, n, at[b])


@loop
def averaged_rate(rows, last, half, at, out):
    """Write the mean rate of release from ``half`` [s] before each time to as long after it.

    Nothing is released before 0.
    """
    n_begin = n_end = 0
    end, gone = -1.0, 0.0
    for b in range(at.size):
        begin = max(at[b] - half, 0.0)
        if begin == end:
            before, n_begin = gone, n_end
        else:
            before, n_begin = value_at(rows, last, RELEASED, n_begin, begin)
        end = at[b] + half
        gone, n_end = value_at(rows, last, RELEASED, n_end, end)
        out[b] = (gone - before) / max(end - begin, 1e-9)


@loop
def sampled_rate(rows, last, at, out):
    """Write the time derivative of what was released; after the end it is zero."""
    time, value, rate = rows[:, TIME], rows[:, RELEASED], rows[:, RATE]
    n = 0
    for b in range(at.size):
        n = find(time, last, n, at[b])
        out[b] = 0.0
        if at[b] <= time[0]:
            out[b] = rate[0]
        elif n < last:
            h = time[n + 1] - time[n]
            s = (at[b] - time[n]) / h
            mean = 6.0 * s * (1.0 - s) * (value[n + 1] - value[n]) / h
            ends = (1.0 - s) * (1.0 - 3.0 * s) * rate[n] + s * (3.0 * s - 2.0) * rate[n + 1]
            out[b] = mean + ends


@loop
def sample(trace, outcome, asked, at, out):
    """Write all that is asked of the runs of a trace, one signal behind the other.

    ``trace`` has shape (runs, steps, columns); ``at``, times [s], and ``out`` (runs, points).
    """
    for lane in range(at.shape[0]):
        rows, last = trace[lane], int(outcome[lane, STEPS])
        for a in range(asked.column.size):
            begin, end = asked.begin[a], asked.begin[a + 1]
            times, curve = at[lane, begin:end], out[lane, begin:end]
            if asked.column[a] != RATE:
                sampled(rows, last, asked.column[a], times, curve)
            elif asked.half[a] == 0.0:
                sampled_rate(rows, last, times, curve)
            else:
                averaged_rate(rows, last, asked.half[a], times, curve)
