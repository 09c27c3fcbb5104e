"""The plain arrays that the kernels work on, and how a run can end.

Symbols: i component, j reaction, n cell, T temperature node of the property tables. Parameter sets
that run side by side, each in its lane, share integers and truth values. The last axis of every
other array is the lanes, and every number below is an array of shape (lanes,).
"""

from collections.abc import Mapping
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]
Value = float | FloatArray
Values = Mapping[str, Value]
"""Parameter values in SI units by name, each a number or of shape (sets,)."""
Number = FloatArray
"""One number per lane, shape (lanes,); in the kernels a number."""

TABLE_START_K = 200.0
TABLE_STEP_K = 5.0
TABLE_SIZE = 281
TABLE_TEMPERATURES_K: FloatArray = np.linspace(
    TABLE_START_K, TABLE_START_K + TABLE_STEP_K * (TABLE_SIZE - 1), TABLE_SIZE
)
"""Nodes [K] of every temperature-dependent property; outside them the end values hold."""


class Status(IntEnum):
    """How a run ended; the text of each member is its explanation."""

    OK = 0
    UNBURNT = 1
    DIVERGED = 2
    NON_FINITE = 3
    TOO_MANY_STEPS = 4
    PROGRAM_FAILED = 5

    @property
    def finished(self) -> bool:
        """Whether the curves of the run can be used."""
        return self in (Status.OK, Status.UNBURNT)

    @property
    def explanation(self) -> str:
        """The explanation in words."""
        return _EXPLANATIONS[self]


_EXPLANATIONS = {
    Status.OK: "the run is complete and the sample has burnt out",
    Status.UNBURNT: "the run is complete, reactant was left at its end",
    Status.DIVERGED: "a temperature left the range 50 K to 5000 K",
    Status.NON_FINITE: "a temperature or mass was not a number",
    Status.TOO_MANY_STEPS: "the step control needed more steps than allowed",
    Status.PROGRAM_FAILED: "the external program failed; see the folder programs/ of the results",
}


class Material(NamedTuple):
    """Properties of the components."""

    specific_volume: FloatArray
    """1 / rho_i [m3/kg], shape (components,)."""
    expansion: FloatArray
    """Volume over that, chi_i(T) [-], shape (components, table nodes or 1)."""
    conductivity: FloatArray
    """k_i(T) [W/(m K)], shape (components, table nodes or 1)."""
    specific_heat: FloatArray
    """c_i(T) [J/(kg K)], shape (components, table nodes or 1)."""
    emissivity: FloatArray
    """eps_i [-], shape (components,)."""
    absorption: FloatArray
    """kappa_i(T) [1/m], shape (components, table nodes or 1); 0 = opaque."""
    alike: IntArray
    """The first component with the tables of component i, shape (components,)."""
    constant: BoolArray
    """Whether all values of its tables are the same, shape (components,)."""


class Network(NamedTuple):
    """Reactions, sorted so that whatever a reaction forms reacts after it."""

    reactant: IntArray
    """Component consumed by reaction j."""
    root_factor: FloatArray
    """Square root of A_j [1/s^0.5]."""
    activation_temperature: FloatArray
    """E_j / R [K]."""
    order: FloatArray
    """n_j [-]."""
    catalysis: FloatArray
    """K_j of autocatalysis [-]."""
    oxygen_order: FloatArray
    """Exponent n of the volume fraction of oxygen [-]; 0 = needs none."""
    oxygen_fall: FloatArray
    """Fall of ln k_j with depth, n over the depth in which oxygen falls to 1/e [1/m]."""
    oxygen_use: FloatArray
    """Oxygen used up [kg per kg of reactant]; 0 = the supply is never short."""
    heat: FloatArray
    """dh_j [J per kg of reactant], positive = endothermic."""
    yields: FloatArray
    """Solid yields nu_ji [kg/kg], shape (reactions, components)."""
    gas: FloatArray
    """Gas yield 1 - sum_i nu_ji [kg/kg]."""
    combustion: FloatArray
    """Heat of combustion of the gas of reaction j [J per kg of gas]."""
    glow: FloatArray
    """Heat that a reaction with oxygen releases [J per kg of reactant]; 0 of the others."""
    burns: bool
    """Whether the heat of combustion released is recorded."""
    oxidises: bool
    """Whether the rate of some reaction follows the oxygen at the surface and the depth."""
    first_order: bool
    """Whether every n_j is 1, and every K_j 0."""
    catalysed: bool
    """Whether some K_j is not 0."""
    plain: bool
    """Whether every reaction has its own reactant and at most one, inert, product."""
    residue: IntArray
    """That product of reaction j."""
    residue_yield: FloatArray
    """Its yield nu_j [kg/kg], zero without a product."""


TIME, FLUX, FRONT_H, FRONT_GAS, FRONT_WALL, BACK_H, BACK_GAS, BACK_WALL = range(8)
FLAME, LIT, OXYGEN = range(8, 11)
"""Rows of the schedule: time [s], external flux [W/m2], and of each side the constant part of the
heat transfer coefficient [W/(m2 K)], gas and wall temperature [K]. The last three hold from one
point to the next: heat flux of the flame [W/m2], whether the gas burns, 1 or 0, and the volume
fraction of oxygen at the front."""


class Surface(NamedTuple):
    """The parts of the heat exchange of one side that follow no table, SI units."""

    h_cube_root: Number
    """C of the part C |T - T_gas|^(1/3) [W/(m2 K^(4/3))]."""
    gas_rise: Number
    """Rise of the gas temperature in the long run [K]."""
    gas_rise_time: Number
    """Time constant of that [s]; 0 = at once."""


class Exposure(NamedTuple):
    """The surroundings that act on the sample."""

    front: Surface
    back: Surface
    schedule: FloatArray
    """The quantities given over time, linear between points, shape (rows, points), see `TIME`. A
    step is given by two equal times, a constant by one point."""
    rise_time: Number
    """Time constant with which the heater comes up [s]; 0 = at once."""
    drift: Number
    """Relative change of the flux per second, at the start [1/s]."""
    drift_time: Number
    """Time constant with which the drift comes to an end [s]; 0 = never."""
    back_emissivity: Number
    foil_capacity: Number
    """Heat capacity per area of the foil on the back [J/(m2 K)]."""
    contact_resistance: Number
    """Between sample and foil [m2 K/W]."""
    back_absorbs: bool
    """Whether the foil, or the back face without one, absorbs radiation that passes the sample."""
    surface_share: Number
    """Share of the radiation that a translucent sample absorbs at its surface [-]."""
    gas_heat: Number
    """Specific heat of the gas that passes the hot layers [J/(kg K)]."""
    mixing_depth: Number
    """delta [m]: depth over which the surface emissivity is averaged by volume."""
    emissivity_change: Number
    """Change of the surface emissivity from virgin to burnt out, with the mass released."""
    backing_mass: Number
    """Of the inert layers behind the sample [kg/m2]."""
    backing_thickness: Number
    """[m]."""
    backing_cells: Number
    """Number of their cells."""
    edge_exchange: Number
    """Heat transfer coefficient of the edge times perimeter over area [W/(m3 K)]."""
    edge_temperature: Number
    """Of the gas there [K]."""


class Description(NamedTuple):
    """The problem that a run solves: the substance and its surroundings."""

    material: Material
    network: Network
    exposure: Exposure


class Start(NamedTuple):
    """The state in which a run begins."""

    mass: FloatArray
    """Masses of the cells [kg/m2], shape (cells, components, lanes), front first."""
    empty: IntArray
    """Number of empty cells in front, shape (lanes,)."""
    temperature: FloatArray
    """[K], shape (lanes,)."""


class End(NamedTuple):
    """Where a run ends."""

    time: Number
    """[s]."""
    when_burnt: bool
    """Whether it ends before, as soon as the reactant is gone."""


class Numerics(NamedTuple):
    """How finely the equations are solved."""

    tolerance: float
    """Bound on the scaled predictor-corrector difference of a step."""
    first_step: float
    """[s]."""
    longest_step: float
    """[s]."""
    most_steps: int
    led: bool = False
    """Whether all lanes take time steps, leave cells and burn out as the first one does."""


class Probes(NamedTuple):
    """Where temperatures inside the sample are asked for."""

    material: FloatArray
    """Places that follow the material: cells of the virgin sample in front of them, shape
    (lanes, probes)."""
    fixture: FloatArray
    """Places that stay where they are: heights above the back face [m], shape (lanes, probes)."""


class Asked(NamedTuple):
    """The signals that are asked of a run, one behind the other."""

    column: IntArray
    """Columns of the trace, shape (signals,)."""
    half: FloatArray
    """Half the width of the bins over which the rate is averaged [s]; 0 = none."""
    begin: IntArray
    """First point of each signal, and the one behind the last, shape (signals + 1,)."""
