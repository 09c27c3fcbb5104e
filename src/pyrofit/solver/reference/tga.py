"""Thermogravimetric analysis by the reference solver."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from pyrofit.model.accuracy import Resolution
from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray, Status
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.outputs import FRACTION_RATE, HEAT_FLOW, HEAT_RELEASE, MASS_FRACTION
from pyrofit.solver.reference.bdf import ReferenceBdf
from pyrofit.solver.reference.factors import dense_factor
from pyrofit.solver.reference.substance import (
    NumericSubstance,
    Reactions,
    mass_fractions,
    substance,
)

PERTURBED = 1e-7
"""Difference of an extent for the Jacobian."""
SHARE = 0.2
"""Allowed error of a step of the integrator, as a share of the tolerance."""
STRAIGHT_K = 1e-9
"""Deviation from a line up to which temperatures belong to one heating rate [K]."""


def reference_tga(
    experiment: HeatedExperiment,
    material: Material,
    values: Mapping[str, float],
    request: Request,
    resolution: Resolution | None = None,
) -> Curves:
    """Simulate a sample that follows a programme, as `pyrofit.simulate.simulate_tga` does.

    Arguments and result are the same; ``resolution`` holds the numerical settings.
    """
    resolution = resolution or Resolution()
    programme, rise = request.programme()
    lag_min = 0.0 if experiment.is_isothermal else value_of(experiment.lag_s, values) / 60.0
    off = value_of(experiment.temperature_offset_K, values)
    time, T = request.time_s, programme - lag_min * experiment.heating_rate_K_min + off
    solid = substance(material, values)
    reactions = solid.reactions.in_gas(value_of(experiment.oxygen, values))
    virgin = mass_fractions(material.composition, solid.names, values)
    burning = reactions.burning + reactions.glow
    tau = value_of(experiment.response, values) if request.output == HEAT_RELEASE else 0.0
    sample = _Sample(reactions, virgin, burning, tau)
    state = np.zeros((time.size, reactions.A.size + (1 if tau > 0.0 else 0)))
    if tau > 0.0:
        state[0, -1] = linear.product(burning, sample.rates(T[0], state[0, :-1]))
    steps = 0
    for first, last in straight(time, T):
        part = slice(first, last + 1)
        found = _heat(sample, state[first], time[part], T[part], resolution.tga_tolerance)
        if found is None:
            return Curves(Status.NON_FINITE, {}, steps=steps)
        state[part] = found[0]
        steps += found[1]
    extent = state[:, : reactions.A.size]
    rate = sample.rates(T, extent)
    signals = {
        MASS_FRACTION: 1.0 - linear.product(extent, reactions.gas),
        FRACTION_RATE: linear.product(rate, reactions.gas),
        HEAT_FLOW: _heat_flow(
            solid, virgin + linear.product(extent, reactions.change), rate, T, rise
        )
        + _baseline(experiment, T, values),
        HEAT_RELEASE: state[:, -1] if tau > 0.0 else linear.product(rate, burning),
    }
    return Curves(Status.OK, signals, steps=steps)


@dataclass(frozen=True)
class _Sample:
    """A reacting sample; the heat of its burning gas is recorded with the time constant tau."""

    reactions: Reactions
    virgin: FloatArray
    burning: FloatArray
    """[J per kg of reactant]."""
    tau: float
    """[s]; zero = the record has no inertia, and is no part of the state."""

    def rates(self, T: FloatArray | float, extent: FloatArray) -> FloatArray:
        """Return the consumption by each reaction per kg of virgin sample [1/s]."""
        k = self.reactions.rate_constants(T)
        return np.asarray(k * self.reactions.amounts(self.virgin, extent))

    def derivative(self, T: float, state: FloatArray) -> FloatArray:
        """Return d state / dt: extents, then tau dy/dt = sum of burning rates - y."""
        if self.tau == 0.0:
            return self.rates(T, state)
        rates = self.rates(T, state[:-1])
        return np.append(rates, (linear.product(self.burning, rates) - state[-1]) / self.tau)


def _heat_flow(
    solid: NumericSubstance, mass: FloatArray, rate: FloatArray, T: FloatArray, rise: FloatArray
) -> FloatArray:
    """Return sum_i m_i c_i(T) dT/dt + sum_j dh_j r_j [W/kg], shape (points,)."""
    sensible = np.sum(mass * solid.specific_heat.of(T), axis=1) * rise
    return np.asarray(sensible + linear.product(rate, solid.reactions.heat))


def _baseline(
    experiment: HeatedExperiment, T: FloatArray, values: Mapping[str, float]
) -> FloatArray:
    line = experiment.line
    above = T - value_of(line.reference_temperature_K, values)
    return value_of(line.level_W_kg, values) + value_of(line.slope_W_kgK, values) * above


def straight(time: FloatArray, T: FloatArray) -> Iterator[tuple[int, int]]:
    """Yield first and last point of each part of the program that has one heating rate."""
    first = 0
    while first < time.size - 1:
        rate = (T[first + 1] - T[first]) / (time[first + 1] - time[first])
        off = np.abs(T[first:] - T[first] - rate * (time[first:] - time[first])) > STRAIGHT_K
        last = first + int(off.argmax()) - 1 if off.any() else time.size - 1
        last = max(last, first + 1)
        yield first, last
        first = last


def _heat(
    sample: _Sample, start: FloatArray, time: FloatArray, T: FloatArray, tolerance: float
) -> tuple[FloatArray, int] | None:
    """Return the states at the times of a straight part and the steps taken, None if it failed."""
    rate = (T[-1] - T[0]) / (time[-1] - time[0])

    def derivative(t: float, state: FloatArray) -> FloatArray:
        return sample.derivative(T[0] + rate * (t - time[0]), state)

    def jacobian(t: float, state: FloatArray) -> FloatArray:
        # Backwards, where there is something to react.
        moved = state - PERTURBED * np.eye(state.size)
        here = derivative(t, state)
        return np.stack([(here - derivative(t, y)) / PERTURBED for y in moved], axis=1)

    if start.size == 0:
        return np.empty((time.size, 0)), 0
    ends = float(time[0]), start, float(time[-1])
    # The errors of the steps add up.
    own = SHARE * tolerance
    absolute = np.full(start.size, own)
    if sample.tau > 0.0:
        # The last unknown is a heat release rate, not a part of the sample.
        absolute[-1] *= max(1.0, float(np.max(np.abs(sample.burning), initial=0.0)))
    solver = ReferenceBdf(derivative, *ends, own, absolute, jacobian, dense_factor)
    states = np.empty((time.size, start.size))
    states[0] = start
    filled, steps = 1, 0
    while solver.status == "running":
        solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            return None
        steps += 1
        to = int(np.searchsorted(time, solver.t, side="right"))
        if to > filled:
            states[filled:to] = solver.dense_output()(time[filled:to]).T
            filled = to
    return states, steps
