"""The least value of a quadratic function within limits, for `pyrofit.estimate.quadratic`."""

import numpy as np

from pyrofit.compiled.jit import inner, short

LEAST_SLOPE = 1e-13
"""Slopes at a limit count as zero below this share of the largest one."""


@inner
def factor(square, index, count, left):
    """Fill L of L L^T = B in the numbers of the index; return whether B is positive definite."""
    for i in range(count):
        for j in range(i + 1):
            value = square[index[i], index[j]]
            for k in range(j):
                value -= left[i, k] * left[j, k]
            if j < i:
                left[i, j] = value / left[j, j]
            elif value > 0.0:
                left[i, i] = np.sqrt(value)
            else:
                return False
    return True


@inner
def solve(left, count, b):
    """Bring b of L L^T x = b to x."""
    for i in range(count):
        for k in range(i):
            b[i] -= left[i, k] * b[k]
        b[i] /= left[i, i]
    for i in range(count - 1, -1, -1):
        for k in range(i + 1, count):
            b[i] -= left[k, i] * b[k]
        b[i] /= left[i, i]


@inner
def aim(square, slope, x, free, room, end):
    """Fill the least point that the free numbers lead to; return whether there is one."""
    index, b, left = room
    count = 0
    for i in range(x.size):
        end[i] = x[i]
        if free[i]:
            index[count] = i
            count += 1
    for a in range(count):
        b[a] = -slope[index[a]]
        for i in range(x.size):
            if not free[i]:
                b[a] -= square[index[a], i] * x[i]
    if not factor(square, index, count, left):
        return False
    solve(left, count, b)
    for a in range(count):
        end[index[a]] = b[a]
    return True


@inner
def first_limit(x, end, low, high):
    """Return which number meets a limit first on the way to the end, and at which part of it."""
    found, share = -1, np.inf
    for i in range(x.size):
        if end[i] < low[i] or end[i] > high[i]:
            limit = low[i] if end[i] < low[i] else high[i]
            own = (limit - x[i]) / (end[i] - x[i])
            if own < share:
                found, share = i, own
    return found, share


@inner
def inside(square, slope, low, high, x, free, room, end):
    """Bring x to the least point of the free numbers; those that meet a limit stay there.

    Return whether the square is positive definite.
    """
    while np.any(free):
        if not aim(square, slope, x, free, room, end):
            return False
        k, share = first_limit(x, end, low, high)
        for i in range(x.size):
            x[i] = end[i] if k < 0 else min(max(x[i] + share * (end[i] - x[i]), low[i]), high[i])
        if k < 0:
            return True
        x[k] = low[k] if end[k] < low[k] else high[k]
        free[k] = False
    return True


@inner
def released(square, slope, low, high, x, free):
    """Return the number at a limit that pulls inwards most, -1 if none does."""
    found, most, largest = -1, 0.0, 0.0
    for i in range(x.size):
        largest = max(largest, abs(slope[i]))
    for i in range(x.size):
        if free[i] or low[i] >= high[i]:
            continue
        pull = slope[i]
        for k in range(x.size):
            pull += square[i, k] * x[k]
        falls = -pull if x[i] <= low[i] else pull
        if falls > max(most, LEAST_SLOPE * largest):
            found, most = i, falls
    return found


@short
def least_within(square, slope, low, high):
    """Return x of least x^T B x / 2 + g^T x within limits, and whether B is positive definite."""
    n = slope.size
    x, end, free = np.zeros(n), np.zeros(n), np.ones(n, np.bool_)
    room = np.empty(n, np.int64), np.empty(n), np.empty((n, n))
    if not aim(square, slope, x, free, room, end):
        return x, False
    for i in range(n):
        x[i] = min(max(end[i], low[i]), high[i])
        free[i] = low[i] < x[i] < high[i]
    if np.all(free):
        return x, True
    for _ in range(10 * n):
        if not inside(square, slope, low, high, x, free, room, end):
            return x, False
        k = released(square, slope, low, high, x, free)
        if k < 0:
            break
        free[k] = True
    return x, True
