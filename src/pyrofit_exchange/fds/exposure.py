"""Exposure of a slab: one flux over time, one temperature on each side.

FDS's surroundings are at one temperature T_0 for convection and radiation. With T_0 the gas
temperature at the start, the external flux

    q(t) + sigma (T_wall^4 - T_0^4) + h (T_gas(t) - T_0)/eps

leaves the same net flux as separate temperatures of gas and walls. Behind the sample T_0 is the
root of h T_0 + eps sigma T_0^4 = h T_gas + eps sigma T_wall^4: the loss is the same at any
temperature of the back.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.model.base import value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.model.slab_faces import Side
from pyrofit.numerics import functions
from pyrofit.solver.arrays import (
    BACK_GAS,
    BACK_H,
    BACK_WALL,
    FLAME,
    FLUX,
    FRONT_GAS,
    FRONT_H,
    FRONT_WALL,
    TIME,
    FloatArray,
)
from pyrofit.solver.schedule import lower_schedule
from pyrofit_exchange.fds.materials import Values
from pyrofit_exchange.fds.predicted import PredictedByPyrofit
from pyrofit_exchange.fds.remarks import Remark

STEP_S, CURVED = 0.01, 300
"""Time that a step of a ramp takes, and points of a flux that follows a curve."""


class Flux(NamedTuple):
    """The external flux [W/m2] over time [s], linear between points."""

    time_s: FloatArray
    value_W_m2: FloatArray


class FdsSurroundings(NamedTuple):
    """The surroundings of a slab in FDS's terms, SI units.

    Parameters
    ----------
    flux
        External flux as FDS takes it.
    heater_W_m2
        The heater's part of it, at the same times.
    h_front, gas_K
        Heat transfer coefficient of the front, and the temperature of all surroundings there.
    h_back, emissivity_back, back_K
        The same of the back; none for a natural convection with ``cube_root``.
    cube_root
        C of h = C |dT|^(1/3) behind [W/(m2 K^(4/3))].
    remarks
        The terms that are not written exactly.
    """

    flux: Flux
    heater_W_m2: FloatArray
    h_front: float
    gas_K: float
    h_back: float | None
    emissivity_back: float
    back_K: float
    cube_root: float
    remarks: tuple[Remark, ...]

    @classmethod
    def still(cls, T: float) -> "FdsSurroundings":
        """Return surroundings at one temperature [K], without any exchange."""
        flux = Flux(np.zeros(1), np.zeros(1))
        return cls(flux, np.zeros(1), 0.0, T, 0.0, 0.0, T, 0.0, ())

    @property
    def is_insulated(self) -> bool:
        """Whether nothing leaves through the back."""
        return self.h_back == 0.0 and self.emissivity_back == 0.0


def surroundings(
    experiment: SlabExperiment,
    values: Values,
    predicted: PredictedByPyrofit,
    emissivity: float,
    has_cube_root: bool,
) -> FdsSurroundings:
    """Return the surroundings of a slab in FDS's terms.

    Parameters
    ----------
    experiment, values
        The description and its numbers.
    predicted
        The curves of pyrofit, along which terms that FDS cannot follow are averaged.
    emissivity
        Of the virgin front.
    has_cube_root
        Whether the version takes a coefficient of natural convection.
    """
    schedule = lower_schedule(experiment, values, 1)[:, :, 0]
    remarks: list[Remark] = []
    gas = float(schedule[FRONT_GAS, 0])
    h = _front_h(experiment, values, schedule, predicted, remarks)
    flux, heater = _flux(experiment, values, schedule, predicted.end_s, (h, gas, emissivity))
    back = _back(experiment, values, schedule, predicted, has_cube_root, remarks)
    return FdsSurroundings(flux, heater, h, gas, *back, tuple(remarks))


def _mean(schedule: FloatArray, row: int, end_s: float) -> float:
    """Return the mean over time of a row of the schedule."""
    t = np.linspace(0.0, end_s, 2001)
    return float(np.mean(np.interp(t, schedule[TIME], schedule[row])))


def _excess(side: Side, values: Values, face: FloatArray, gas: float) -> float:
    """Return the mean of C |T - T_gas|^(1/3) over a predicted course of the face."""
    C = value_of(side.h_cube_root_W_m2K43, values)
    return C * float(np.mean(functions.cube_root(np.abs(face - gas)))) if C else 0.0


def _front_h(
    experiment: SlabExperiment,
    values: Values,
    schedule: FloatArray,
    predicted: PredictedByPyrofit,
    remarks: list[Remark],
) -> float:
    h = _mean(schedule, FRONT_H, predicted.end_s)
    if np.ptp(schedule[FRONT_H]) > 0.0:
        how = f"its mean over the test, {h:.4g} W/(m2 K)"
        remarks.append(Remark("approximate", "front h that changes (front.h_W_m2K)", how))
    more = _excess(experiment.front, values, predicted.front_K, float(schedule[FRONT_GAS, 0]))
    if more:
        how = f"a constant {more:.4g} W/(m2 K), the mean over pyrofit's curve"
        what = "natural convection of the front (front.h_cube_root_W_m2K43)"
        remarks.append(Remark("approximate", what, how))
    return h + more


def _flux(
    experiment: SlabExperiment,
    values: Values,
    schedule: FloatArray,
    end_s: float,
    at: tuple[float, float, float],
) -> tuple[Flux, FloatArray]:
    """Return the flux that allows one temperature of gas and walls, and the heater's part."""
    h, gas, emissivity = at
    front = experiment.front
    rise_time = value_of(front.rise_time_s, values)
    drift, rest = value_of(front.drift_1_s, values), value_of(front.drift_time_s, values)
    rise, to_rise = value_of(front.gas_rise_K, values), value_of(front.gas_rise_time_s, values)
    t, given = _points(schedule, end_s, bool(rise_time or drift or (rise and to_rise)))
    drifted = rest * _approach(t, rest) if rest > 0.0 else t
    heater = given[FLUX] * _approach(t, rise_time) * np.maximum(1.0 + drift * drifted, 0.0)
    walls = STEFAN_BOLTZMANN * (
        functions.fourth_power(given[FRONT_WALL]) - functions.fourth_power(gas)
    )
    warmer = given[FRONT_GAS] + rise * _approach(t, to_rise) - gas
    return Flux(t, heater + given[FLAME] + walls + h * warmer / emissivity), heater


def _approach(t: FloatArray, time: float) -> FloatArray:
    """Return 1 - exp(-t/time), as the solver has it."""
    return 1.0 - functions.exp(-t / time) if time > 0.0 else np.ones(t.shape)


def _points(schedule: FloatArray, end_s: float, curved: bool) -> tuple[FloatArray, FloatArray]:
    """Return times and the schedule at them; a step takes a short time."""
    times = _apart(schedule[TIME])
    if not curved:
        return times, schedule
    t = np.union1d(times, functions.geometric(0.05, max(end_s, 1.0), CURVED))
    at = np.array([np.interp(t, times, row) for row in schedule])
    at[FLAME] = schedule[FLAME][np.searchsorted(times, t, side="right") - 1]
    return t, at


def _apart(times: FloatArray) -> FloatArray:
    """Return times of which the second of two equal ones is later by the time of a step."""
    out = times.copy()
    out[1:][np.diff(times) <= 0.0] += STEP_S
    return out


def _back(
    experiment: SlabExperiment,
    values: Values,
    schedule: FloatArray,
    predicted: PredictedByPyrofit,
    has_cube_root: bool,
    remarks: list[Remark],
) -> tuple[float | None, float, float, float]:
    """Return h, emissivity and temperature of the back, and C of its natural convection."""
    back = experiment.back
    factor = value_of(back.loss_factor, values)
    h, gas, wall = (_mean(schedule, row, predicted.end_s) for row in (BACK_H, BACK_GAS, BACK_WALL))
    gas += _gas_rise(back, values, predicted.end_s)
    changes = np.ptp(schedule[[BACK_H, BACK_GAS, BACK_WALL]], axis=1).any()
    if changes or value_of(back.gas_rise_K, values):
        what = "back h or temperatures that change (back)"
        remarks.append(Remark("approximate", what, "their means over the test"))
    emissivity = factor * value_of(back.emissivity, values)
    if emissivity > 1.0:
        more = (emissivity - 1.0) * 4.0 * STEFAN_BOLTZMANN * float(np.mean(predicted.back_K)) ** 3
        how = f"1, and {more:.4g} W/(m2 K) more of convection"
        what = "back emissivity times loss factor above 1 (back.loss_factor)"
        remarks.append(Remark("approximate", what, how))
        h, emissivity = h + more, 1.0
    C = factor * value_of(back.h_cube_root_W_m2K43, values)
    if C and has_cube_root and h == 0.0 and abs(gas - wall) < 0.01:
        return None, emissivity, gas, C
    if C:
        more = factor * _excess(back, values, predicted.back_K, gas)
        how = f"a constant {more:.4g} W/(m2 K), the mean over pyrofit's curve"
        what = "natural convection of the back (back.h_cube_root_W_m2K43)"
        remarks.append(Remark("approximate", what, how))
        h += more
    return h, emissivity, _one_temperature(h, emissivity, gas, wall), 0.0


def _gas_rise(side: Side, values: Values, end_s: float) -> float:
    """Return the mean rise of the gas temperature over the test."""
    t = np.linspace(0.0, end_s, 2001)
    rise, time = value_of(side.gas_rise_K, values), value_of(side.gas_rise_time_s, values)
    return float(np.mean(rise * _approach(t, time)))


def _one_temperature(h: float, emissivity: float, gas: float, wall: float) -> float:
    """Return the temperature with which convection and radiation together are as with two.

    >>> _one_temperature(4.0, 0.95, 300.0, 300.0)
    300.0
    """
    if gas == wall or (h == 0.0 and emissivity == 0.0):
        return gas
    eps = emissivity * STEFAN_BOLTZMANN
    both = h * gas + eps * wall**4
    low, high = sorted((gas, wall))
    return float(brentq(lambda T: h * T + eps * T**4 - both, low - 1.0, high + 1.0))
