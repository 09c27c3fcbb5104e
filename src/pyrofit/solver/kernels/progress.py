"""Where the runs of all lanes are, from one step to the next."""

from typing import NamedTuple

from pyrofit.compiled.jit import inner
from pyrofit.solver.arrays import FLAME, FLUX, Number, Status
from pyrofit.solver.kernels.bdf import (
    Balance,
    Clock,
    booked,
    either,
    kept,
    retry,
    start_clock,
    tick,
)
from pyrofit.solver.kernels.lanes import opposite, where

GASIFICATION_SCALE = 2.0e6
"""Heat of gasification [J/kg] that turns the flux into the mass loss rate it could sustain."""
LEAST_FLUX_SCALE = 5.0e3
"""[W/m2]; keeps that rate above zero without external flux."""
ONSET_SHARE = 0.01
"""Share of that rate to which the error of a step is compared at least."""
PEAK_MULTIPLE = 2.0
"""The error is compared to this multiple of the largest rate so far."""
OK, UNBURNT = float(Status.OK), float(Status.UNBURNT)
TOO_MANY_STEPS = float(Status.TOO_MANY_STEPS)


class Top(NamedTuple):
    """The state that a step starts from, besides the cells."""

    front: Number
    """Front temperature [K]."""
    front_old: Number
    """The same a step before [K]."""
    eps: Number
    """Front emissivity."""
    converted: Number
    """Mass released over initial mass."""


class Progress(NamedTuple):
    """The progress of the runs; a lane that has ended keeps its values."""

    clock: Clock
    top: Top
    balance: Balance
    mass: Number
    """Initial mass of the sample [kg/m2]."""
    rate_scale: Number
    """Mass loss rate to which the error of a step is compared [kg/(m2 s)]."""
    running: Number
    """Whether the run goes on."""
    status: Number
    steps: Number
    """Steps accepted."""
    tries: Number
    """Steps accepted or refused."""


@inner
def scale_of_rate(exposure):
    """Return the mass loss rate to which the error is compared at the onset [kg/(m2 s)]."""
    schedule = exposure.schedule
    flux = LEAST_FLUX_SCALE + 0.0 * schedule[FLUX, 0]
    for p in range(schedule.shape[1]):
        flux = max(flux, schedule[FLUX, p] + schedule[FLAME, p])
    return ONSET_SHARE * flux / GASIFICATION_SCALE


@inner
def goes_on(clock, end):
    """Tell whether the end is still ahead."""
    return clock.t < end.time - 1e-9


@inner
def started(mass, T, exposure, numerics, end):
    """Return the start of runs of samples of this mass [kg/m2] and temperature [K]."""
    none = 0.0 * T
    clock = start_clock(none, exposure, numerics, end.time)
    return Progress(
        clock=clock,
        top=Top(T, T, none + 1.0, none),
        balance=Balance(none, none, none, none, none, none),
        mass=mass,
        rate_scale=scale_of_rate(exposure),
        running=goes_on(clock, end),
        status=none + UNBURNT,
        steps=none,
        tries=none,
    )


@inner
def tried(now, status):
    """Return the progress with one more step tried: a lane in which it failed has ended."""
    fine = status == OK
    return Progress(
        clock=now.clock,
        top=now.top,
        balance=now.balance,
        mass=now.mass,
        rate_scale=now.rate_scale,
        running=now.running & fine,
        status=where(now.running & opposite(fine), status, now.status),
        steps=now.steps,
        tries=now.tries + where(now.running, 1.0, 0.0),
    )


@inner
def next_clock(now, again, ratio, exposure, numerics, end):
    """Return the clock of the next step, or, where the last one is tried again, of that."""
    after = either(
        again,
        retry(now.clock, ratio, numerics.first_step, exposure.schedule),
        tick(now.clock, ratio, exposure, numerics, end.time),
    )
    return either(now.running, after, now.clock)


@inner
def moved(now, step, accepted, heat_moved, clock):
    """Return the progress after a step, in the lanes in which it was accepted."""
    used = step.heat + heat_moved
    after = booked(now.balance, now.clock, step.gas, step.burnt, used, step.net_flux)
    balance = kept(accepted, after, now.balance)
    scale = max(now.rate_scale, PEAK_MULTIPLE * step.rate)
    return Progress(
        clock=clock,
        top=Top(
            where(accepted, step.front, now.top.front),
            where(accepted, now.top.front, now.top.front_old),
            where(now.running, step.eps, now.top.eps),
            balance.released / now.mass,
        ),
        balance=balance,
        mass=now.mass,
        rate_scale=where(accepted, scale, now.rate_scale),
        running=now.running,
        status=now.status,
        steps=now.steps + where(accepted, 1.0, 0.0),
        tries=now.tries,
    )


@inner
def ended(now, status, numerics, end):
    """Return the progress with the lanes ended that are at their end or take too many steps."""
    running = now.running & goes_on(now.clock, end)
    if end.when_burnt:
        running = running & (status != OK)
    most = 1.0 * numerics.most_steps
    many = running & ((now.steps >= most) | (now.tries >= 2.0 * most))
    return Progress(
        clock=now.clock,
        top=now.top,
        balance=now.balance,
        mass=now.mass,
        rate_scale=now.rate_scale,
        running=running & opposite(many),
        status=where(many, TOO_MANY_STEPS, status),
        steps=now.steps,
        tries=now.tries,
    )
