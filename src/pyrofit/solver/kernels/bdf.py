"""Time steps: the difference formula, its error control, and the balance from step to step."""

import math
from typing import NamedTuple

from pyrofit.compiled.jit import inner
from pyrofit.solver.arrays import Number
from pyrofit.solver.kernels.functions import root, whole
from pyrofit.solver.kernels.lanes import where
from pyrofit.solver.kernels.schedule import end_of, jumps, piece_of

SAFETY = 0.9
SHRINK, GROW, REJECT = 0.3, 1.6, 0.5
NEAR = 20.0
"""Steps before a point of the schedule from which on they are made equal."""


class Bdf(NamedTuple):
    """dy/dt at the end of a step = b1 (y_new - y) - b3 (y - y_old), second order."""

    dt: Number
    r: Number
    """dt over the step before; 0 at a start, where the formula is Euler's."""
    b1: Number
    b3: Number


class Clock(NamedTuple):
    """Where the run is, and the step it tries next."""

    t: Number
    dt: Number
    dt_old: Number
    """Infinite at a start."""
    piece: Number
    """Piece of the schedule."""
    landing: Number
    """Time that a step must hit: the end of the piece, or of the run [s]."""


class Balance(NamedTuple):
    """Sums from the start of the run."""

    released: Number
    """Gas [kg/m2]."""
    burnt: Number
    """Heat of combustion of the part of it that has burnt [J/m2]."""
    heat_in: Number
    """Heat through the surfaces [J/m2]."""
    heat_crossed: Number
    """The same without sign."""
    heat_used: Number
    """Heat stored and used by reactions [J/m2]."""
    heat_last: Number
    """Heat through the surfaces in the last step [J/m2]."""


@inner
def start_clock(t, exposure, numerics, t_end):
    """Return the clock of a start at t, where a run begins or something given jumps."""
    piece = piece_of(t, exposure.schedule)
    landing = end_of(piece, exposure.schedule, t_end)
    dt = numerics.first_step + 0.0 * t
    return hit(t, dt, math.inf + 0.0 * t, piece, landing, exposure.schedule)


@inner
def reaches(t, dt, landing):
    """Tell whether a step ends at the landing, or so close that it should."""
    return t + dt * (1.0 + 1e-9) >= landing


@inner
def hit(t, dt, dt_old, piece, landing, schedule):
    """Return the clock, its step shortened if it would pass the landing.

    On the way to a point of the schedule steps are equal: a short last one would be followed by
    others.
    """
    if schedule.shape[1] > 1:
        left = max(landing - t, 0.0) / dt
        count = whole(min(left, NEAR))
        count = max(count + where(left > count + 1e-9, 1.0, 0.0), 1.0)
        ahead = (piece < schedule.shape[1] - 1.0) & (left > 0.0) & (left < NEAR)
        dt = where(ahead, (landing - t) / count, dt)
    return Clock(t, where(reaches(t, dt, landing), landing - t, dt), dt_old, piece, landing)


@inner
def either(condition, a, b):
    """Return clock a where the condition holds, b elsewhere."""
    return Clock(
        where(condition, a.t, b.t),
        where(condition, a.dt, b.dt),
        where(condition, a.dt_old, b.dt_old),
        where(condition, a.piece, b.piece),
        where(condition, a.landing, b.landing),
    )


@inner
def formula(clock):
    """Return the coefficients of the step."""
    dt = clock.dt
    r = dt / clock.dt_old
    return Bdf(dt, r, (1.0 + 2.0 * r) / (1.0 + r) / dt, r * r / (1.0 + r) / dt)


@inner
def retry(clock, ratio, first_step, schedule):
    """Return the clock with a shorter step."""
    dt = max(clock.dt * max(ratio, SHRINK), first_step)
    return hit(clock.t, dt, clock.dt_old, clock.piece, clock.landing, schedule)


@inner
def rejected(clock, ratio, first_step):
    """Tell whether the error of a step is too large, and the step can be shortened."""
    return (ratio < REJECT) & (clock.dt > 1.001 * first_step)


@inner
def tick(clock, ratio, exposure, numerics, t_end):
    """Return the clock after the step.

    Where something given only bends, the steps go on: two measured points may be closer than them.
    """
    dt = min(clock.dt * min(ratio, GROW), numerics.longest_step)
    on = hit(clock.t + clock.dt, dt, clock.dt, clock.piece, clock.landing, exposure.schedule)
    landed = reaches(clock.t, clock.dt, clock.landing)
    fresh = start_clock(clock.landing, exposure, numerics, t_end)
    bent = hit(clock.landing, dt, clock.dt, fresh.piece, fresh.landing, exposure.schedule)
    after = either(jumps(clock.landing, exposure.schedule), fresh, bent)
    return either(landed, after, on)


@inner
def step_ratio(error, tolerance):
    """Return the factor by which the next step should differ from this one."""
    return SAFETY * root(tolerance / (error + 1e-30))


@inner
def booked(balance, clock, gas, burnt, heat_used, net_flux):
    """Return the balance after a step with this net flux at its end [W/m2].

    Heat enters as the formula integrates it: net_flux = b1 heat - b3 heat_last.
    """
    bdf = formula(clock)
    heat = (net_flux + bdf.b3 * balance.heat_last) / bdf.b1
    return Balance(
        balance.released + gas,
        balance.burnt + burnt,
        balance.heat_in + heat,
        balance.heat_crossed + abs(heat),
        balance.heat_used + heat_used,
        heat,
    )


@inner
def kept(condition, new, old):
    """Return the new balance where the condition holds, the old one elsewhere."""
    return Balance(
        where(condition, new.released, old.released),
        where(condition, new.burnt, old.burnt),
        where(condition, new.heat_in, old.heat_in),
        where(condition, new.heat_crossed, old.heat_crossed),
        where(condition, new.heat_used, old.heat_used),
        where(condition, new.heat_last, old.heat_last),
    )


@inner
def energy_error(balance):
    """Return the heat that is not accounted for, relative to the heat that crossed the surfaces."""
    crossed = balance.heat_crossed
    off = abs(balance.heat_in - balance.heat_used)
    return where(crossed == 0.0, 0.0, off / max(crossed, 1e-300))
