"""What acts on the slab from outside: its two sides, its edge and the external flux over time."""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.model.base import value_of
from pyrofit.model.slab import Edge, Flame, FluxTable, Front, Side
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.reference.substance import Values


def approached(t: float, time: float) -> float:
    """Return 1 - exp(-t/time), 1 where there is no time to wait."""
    return -math.expm1(-t / time) if time > 0.0 else 1.0


@dataclass(frozen=True)
class Surface:
    """Exchange of a side with its surroundings."""

    h: float
    h_cube_root: float
    gas: float
    """Gas temperature at the start [K]."""
    gas_rise: float
    gas_rise_time: float
    wall: float

    def gain(self, emissivity: float, T: FloatArray, t: float) -> FloatArray:
        """Return eps sigma (T_wall^4 - T^4) - h (T - T_gas(t)) [W/m2]."""
        above = T - (self.gas + self.gas_rise * approached(t, self.gas_rise_time))
        h = self.h + self.h_cube_root * np.cbrt(np.abs(above))
        return np.asarray(emissivity * STEFAN_BOLTZMANN * (self.wall**4 - T**4) - h * above)


def surface(side: Side, values: Values, factor: float = 1.0) -> Surface:
    """Return one side with numbers, its convection multiplied by the factor."""
    h = value_of(side.h_W_m2K, values) + value_of(side.h_change_W_m2K, values)
    return Surface(
        h=factor * max(h, 0.0),
        h_cube_root=factor * value_of(side.h_cube_root_W_m2K43, values),
        gas=value_of(side.gas_temperature_K, values),
        gas_rise=value_of(side.gas_rise_K, values),
        gas_rise_time=value_of(side.gas_rise_time_s, values),
        wall=value_of(side.wall_temperature_K, values),
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
    """What the heater makes of the flux it is set to."""

    factor: float
    rise_time: float
    drift: float
    drift_time: float

    def share(self, t: float) -> float:
        """Return the flux over the one it is set to: it comes up, and drifts, never below zero."""
        drifted = self.drift_time * approached(t, self.drift_time) if self.drift_time > 0.0 else t
        return self.factor * approached(t, self.rise_time) * max(1.0 + self.drift * drifted, 0.0)


@dataclass(frozen=True)
class Piece:
    """A time in which the flux that is set is linear: flux + slope (t - start)."""

    start: float
    end: float
    flux: float
    slope: float
    heater: Heater
    flame: float = 0.0
    """Heat flux of the flame [W/m2]."""

    def at(self, t: float) -> float:
        """Return q_ext(t) and the flame's flux [W/m2], also beyond the end."""
        return self.heater.share(t) * (self.flux + self.slope * (t - self.start)) + self.flame


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
    front: Front, flame: Fire, values: Values, end: float, factor: float = 1.0
) -> Iterator[Piece]:
    """Yield the pieces of ``factor`` times the external flux, and the flame's, up to the end."""
    for piece in _external(front, values, end, factor):
        cuts = sorted({t for t in (flame.begins, flame.ends) if piece.start < t < piece.end})
        for start, until in itertools.pairwise((piece.start, *cuts, piece.end)):
            lit = flame.begins <= start < flame.ends
            flux = piece.flux + piece.slope * (start - piece.start)
            added = flame.flux if lit else 0.0
            yield replace(piece, start=start, end=until, flux=flux, flame=added)


def _external(front: Front, values: Values, end: float, factor: float) -> Iterator[Piece]:
    heater = Heater(
        factor,
        value_of(front.rise_time_s, values),
        value_of(front.drift_1_s, values),
        value_of(front.drift_time_s, values),
    )
    given = front.flux_W_m2
    if not isinstance(given, FluxTable):
        yield Piece(0.0, end, value_of(given, values), 0.0, heater)
        return
    flux = [value_of(q, values) for q in given.flux_W_m2]
    for n, start in enumerate(given.time_s):
        last = n + 1 == len(flux)
        until = math.inf if last else given.time_s[n + 1]
        if start < min(until, end):
            slope = 0.0 if last else (flux[n + 1] - flux[n]) / (until - start)
            yield Piece(start, min(until, end), flux[n], slope, heater)
