"""The surroundings of the slab: its two sides, its edge and the external flux over time."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.model.base import value_of
from pyrofit.model.slab import Edge, SlabExperiment
from pyrofit.model.slab_faces import Flame, Side
from pyrofit.model.time_table import OverTime, TimeTable
from pyrofit.numerics import functions
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.reference.substance import Values


def approached(t: float, time: float) -> float:
    """Return 1 - exp(-t/time), 1 where there is no time to wait."""
    return -math.expm1(-t / time) if time > 0.0 else 1.0


@dataclass(frozen=True)
class LineOverTime:
    """A value that is given over time, between two points of its table."""

    times: tuple[float, ...]
    values: tuple[float, ...]

    def at(self, t: float, piece: tuple[float, float]) -> float:
        """Return the value at t within a piece of time [s] in which the table does not bend."""
        middle = 0.5 * (piece[0] + piece[1])
        n = sum(time <= middle for time in self.times)
        if n == len(self.times):
            return self.values[-1]
        part = (t - self.times[n - 1]) / (self.times[n] - self.times[n - 1])
        return self.values[n - 1] + part * (self.values[n] - self.values[n - 1])


def line_over_time(given: OverTime, values: Values) -> LineOverTime:
    """Return a table with numbers; a number is a table of one point."""
    if isinstance(given, TimeTable):
        return LineOverTime(given.time_s, tuple(value_of(v, values) for v in given.value))
    return LineOverTime((0.0,), (value_of(given, values),))


@dataclass(frozen=True)
class ReferenceSurface:
    """Exchange of a side with its surroundings."""

    h: LineOverTime
    h_cube_root: float
    gas: LineOverTime
    """Gas temperature without its rise [K]."""
    gas_rise: float
    gas_rise_time: float
    wall: LineOverTime

    def convection(
        self, T: FloatArray | float, t: float, piece: tuple[float, float]
    ) -> tuple[FloatArray, FloatArray]:
        """Return h [W/(m2 K)] and T - T_gas [K], all of time t."""
        gas = self.gas.at(t, piece) + self.gas_rise * approached(t, self.gas_rise_time)
        above = np.asarray(T - gas)
        h = self.h.at(t, piece) + self.h_cube_root * functions.cube_root(np.abs(above))
        return np.asarray(h), above

    def gain(
        self, emissivity: float, T: FloatArray, t: float, piece: tuple[float, float]
    ) -> FloatArray:
        """Return eps sigma (T_wall^4 - T^4) - h (T - T_gas) [W/m2], all of time t."""
        h, above = self.convection(T, t, piece)
        wall = self.wall.at(t, piece)
        net = functions.fourth_power(wall) - functions.fourth_power(T)
        return np.asarray(emissivity * STEFAN_BOLTZMANN * net - h * above)


def surface(side: Side, values: Values, factor: float = 1.0) -> ReferenceSurface:
    """Return one side with numbers, its convection multiplied by the factor."""
    h, change = line_over_time(side.h_W_m2K, values), value_of(side.h_change_W_m2K, values)
    return ReferenceSurface(
        h=LineOverTime(h.times, tuple(factor * max(at + change, 0.0) for at in h.values)),
        h_cube_root=factor * value_of(side.h_cube_root_W_m2K43, values),
        gas=line_over_time(side.gas_temperature_K, values),
        gas_rise=value_of(side.gas_rise_K, values),
        gas_rise_time=value_of(side.gas_rise_time_s, values),
        wall=line_over_time(side.wall_temperature_K, values),
    )


@dataclass(frozen=True)
class Rim:
    """Exchange of the edge with the gas beside it, per volume of the sample."""

    exchange: float
    """h times perimeter over area [W/(m3 K)]."""
    gas: float
    """[K]."""

    def gain(self, T: FloatArray, d: FloatArray) -> FloatArray:
        """Return the heat [W/m2] of nodes at T, of which elements of thickness d [m] lie between.

        Every node takes half of the elements beside it.
        """
        beside = np.zeros(T.shape)
        beside[..., :-1] += 0.5 * d
        beside[..., 1:] += 0.5 * d
        return np.asarray(self.exchange * beside * (self.gas - T))


def rim(edge: Edge | None, values: Values) -> Rim:
    """Return the edge with numbers; without one nothing is exchanged."""
    if edge is None:
        return Rim(0.0, 0.0)
    exchange = value_of(edge.h_W_m2K, values) * value_of(edge.perimeter_per_area_1_m, values)
    return Rim(exchange, value_of(edge.gas_temperature_K, values))


@dataclass(frozen=True)
class Heater:
    """The response of the heater to the flux it is set to."""

    factor: float
    rise_time: float
    drift: float
    drift_time: float

    def share(self, t: float) -> float:
        """Return the flux over the one it is set to: it comes up, and drifts, never below zero."""
        drifted = self.drift_time * approached(t, self.drift_time) if self.drift_time > 0.0 else t
        return self.factor * approached(t, self.rise_time) * max(1.0 + self.drift * drifted, 0.0)


@dataclass(frozen=True)
class LinearPiece:
    """A time in which everything given is linear."""

    start: float
    end: float
    flux: LineOverTime
    heater: Heater
    flame: float = 0.0
    """Heat flux of the flame [W/m2]."""
    oxygen: float = 0.0
    """Volume fraction of oxygen at the front [-]."""

    @property
    def span(self) -> tuple[float, float]:
        """Start and end [s]."""
        return self.start, self.end

    def at(self, t: float) -> float:
        """Return q_ext(t) and the flame's flux [W/m2], also beyond the end."""
        return self.heater.share(t) * self.flux.at(t, self.span) + self.flame


@dataclass(frozen=True)
class Fire:
    """The flame with numbers."""

    flux: float
    begins: float
    ends: float
    """[s], infinite where it lasts to the end."""


def fire(flame: Flame | None, values: Values) -> Fire:
    """Return the flame with numbers; without one, gas burns from the start and heats nothing."""
    if flame is None:
        return Fire(0.0, 0.0, math.inf)
    begins = value_of(flame.ignition_s, values)
    ends = math.inf if flame.ends_s is None else value_of(flame.ends_s, values)
    return Fire(value_of(flame.flux_W_m2, values), begins, max(begins, ends))


def pieces(
    experiment: SlabExperiment, flame: Fire, values: Values, end: float, factor: float = 1.0
) -> Iterator[LinearPiece]:
    """Yield the pieces between all given times up to the end, of ``factor`` times the flux."""
    front = experiment.front
    heater = Heater(
        factor * value_of(front.flux_factor, values),
        value_of(front.rise_time_s, values),
        value_of(front.drift_1_s, values),
        value_of(front.drift_time_s, values),
    )
    flux = line_over_time(front.flux_W_m2, values)
    given = [flux]
    for side in (front, experiment.back):
        of_side = (side.h_W_m2K, side.gas_temperature_K, side.wall_temperature_K)
        given += [line_over_time(one, values) for one in of_side]
    times = {t for one in given for t in one.times} | {flame.begins, flame.ends}
    for start, until in pairwise(sorted({t for t in times if t < end} | {end})):
        lit = flame.begins <= start < flame.ends
        burns = lit and experiment.burning() is not None
        oxygen = 0.0 if burns else value_of(experiment.oxygen, values)
        yield LinearPiece(start, until, flux, heater, flame.flux if lit else 0.0, oxygen)


class Outside(NamedTuple):
    """The quantities that act on a state from outside, or depend on it as a whole."""

    t: float
    """[s]."""
    eps: float
    """Emissivity of the front."""
    absorbed: FloatArray
    """External radiation that the nodes absorb [W/m2], shape (nodes,)."""
    span: tuple[float, float]
    """Start and end of the time around t in which everything given is linear [s]."""
    passing: FloatArray | float = 0.0
    """Heat capacity of the gas that passes the elements [W/(m2 K)], shape (elements,)."""
    air: tuple[FloatArray | float, FloatArray | float] = (1.0, 1.0)
    """Factors of the rates by the oxygen at the two points of the elements' rule, shape
    (..., elements, reactions)."""
