"""Curves at requested times from what a run holds at its steps."""

import numpy as np

from pyrofit.solver.kernels.jit import entry


@entry
def held(time, value, rate, at):
    """Return ``value`` at ascending times by cubic Hermite interpolation, held after the end."""
    out = np.empty(at.size)
    n = 0
    last = time.size - 1
    for a in range(at.size):
        while n < last and time[n + 1] < at[a]:
            n += 1
        if at[a] <= time[0]:
            out[a] = value[0]
        elif n == last:
            out[a] = value[last]
        else:
            h = time[n + 1] - time[n]
            s = (at[a] - time[n]) / h
            rise = s * s * (3.0 - 2.0 * s) * (value[n + 1] - value[n])
            bend = h * s * (1.0 - s) * ((1.0 - s) * rate[n] - s * rate[n + 1])
            out[a] = value[n] + rise + bend
    return out


@entry
def held_rate(time, value, rate, at):
    """Return the time derivative of that interpolation; after the end it is zero."""
    out = np.empty(at.size)
    n = 0
    last = time.size - 1
    for a in range(at.size):
        while n < last and time[n + 1] < at[a]:
            n += 1
        if at[a] <= time[0]:
            out[a] = rate[0]
        elif n == last:
            out[a] = 0.0
        else:
            h = time[n + 1] - time[n]
            s = (at[a] - time[n]) / h
            mean = 6.0 * s * (1.0 - s) * (value[n + 1] - value[n]) / h
            ends = (1.0 - s) * (1.0 - 3.0 * s) * rate[n] + s * (3.0 * s - 2.0) * rate[n + 1]
            out[a] = mean + ends
    return out


@entry
def slopes(time, value):
    """Return dvalue/dt at the steps from the parabola through three neighbours."""
    size = time.size
    out = np.zeros(size)
    if size < 2:
        return out
    for n in range(1, size - 1):
        h0 = time[n] - time[n - 1]
        h1 = time[n + 1] - time[n]
        s0 = (value[n] - value[n - 1]) / h0
        s1 = (value[n + 1] - value[n]) / h1
        out[n] = (h1 * s0 + h0 * s1) / (h0 + h1)
    out[0] = (value[1] - value[0]) / (time[1] - time[0])
    out[size - 1] = (value[size - 1] - value[size - 2]) / (time[size - 1] - time[size - 2])
    return out
