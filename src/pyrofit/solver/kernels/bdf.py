"""Time steps: the difference formula, its error control, and what is booked from step to step."""

import math
from typing import NamedTuple

from pyrofit.solver.kernels.heat import flux_piece
from pyrofit.solver.kernels.jit import inner

SAFETY = 0.9
SHRINK, GROW, REJECT = 0.3, 1.6, 0.5


class Bdf(NamedTuple):
    """dy/dt at the end of a step = b1 y_new - b2 y + b3 y_old, second order."""

    dt: float
    r: float
    """dt over the step before; 0 at a start, where the formula is Euler's."""
    b1: float
    b2: float
    b3: float


class Clock(NamedTuple):
    """Where the run is, and the step it tries next."""

    t: float
    dt: float
    dt_old: float
    """Infinite at a start."""
    piece: int
    """Piece of the flux table."""
    landing: float
    """Time that a step must hit: the end of the piece, or of the run [s]."""


class Balance(NamedTuple):
    """Sums from the start of the run."""

    released: float
    """Gas [kg/m2]."""
    heat_in: float
    """Heat through the surfaces [J/m2]."""
    heat_crossed: float
    """The same without sign."""
    heat_used: float
    """Heat stored and used by reactions [J/m2]."""
    net_flux: float
    """Net heat flux at the end of the last step [W/m2]."""


@inner
def start_clock(t, exposure, numerics, t_end):
    """Return the clock of a start at t, where a run begins or the flux changes."""
    p = flux_piece(t, exposure.flux_time)
    landing = t_end
    if p + 1 < exposure.flux_time.size:
        landing = min(landing, exposure.flux_time[p + 1])
    return hit(t, numerics.first_step, math.inf, p, landing)


@inner
def reaches(t, dt, landing):
    """Tell whether a step ends at the landing, or so close that it should."""
    return t + dt * (1.0 + 1e-9) >= landing


@inner
def hit(t, dt, dt_old, piece, landing):
    """Return the clock, its step shortened if it would pass the landing."""
    if reaches(t, dt, landing):
        dt = landing - t
    return Clock(t, dt, dt_old, piece, landing)


@inner
def formula(clock):
    """Return the coefficients of the step."""
    dt = clock.dt
    r = dt / clock.dt_old
    return Bdf(dt, r, (1.0 + 2.0 * r) / (1.0 + r) / dt, (1.0 + r) / dt, r * r / (1.0 + r) / dt)


@inner
def retry(clock, ratio, first_step):
    """Return the clock with a shorter step."""
    dt = max(clock.dt * max(ratio, SHRINK), first_step)
    return hit(clock.t, dt, clock.dt_old, clock.piece, clock.landing)


@inner
def rejected(clock, ratio, first_step):
    """Tell whether the error of a step is too large, and the step can be shortened."""
    return ratio < REJECT and clock.dt > 1.001 * first_step


@inner
def tick(clock, ratio, exposure, numerics, t_end):
    """Return the clock after the step."""
    if reaches(clock.t, clock.dt, clock.landing):
        return start_clock(clock.landing, exposure, numerics, t_end)
    dt = min(clock.dt * min(ratio, GROW), numerics.longest_step)
    return hit(clock.t + clock.dt, dt, clock.dt, clock.piece, clock.landing)


@inner
def step_ratio(error, tolerance):
    """Return the factor by which the next step should differ from this one."""
    return SAFETY * math.sqrt(tolerance / (error + 1e-30))


@inner
def booked(balance, clock, gas, heat_used, net_flux):
    """Return the balance after a step; the surface heat is its trapezoidal integral."""
    before = balance.net_flux if clock.dt_old < math.inf else net_flux
    both = net_flux + before
    return Balance(
        balance.released + gas,
        balance.heat_in + 0.5 * clock.dt * both,
        balance.heat_crossed + 0.5 * clock.dt * abs(both),
        balance.heat_used + heat_used,
        net_flux,
    )


@inner
def energy_error(balance):
    """Return the heat that is not accounted for, relative to what crossed the surfaces."""
    if balance.heat_crossed == 0.0:
        return 0.0
    return abs(balance.heat_in - balance.heat_used) / balance.heat_crossed
