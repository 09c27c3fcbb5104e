"""The slab as a system of ordinary differential equations.

Galerkin's finite elements in the coordinate of the virgin sample: T is linear in an element, the
composition constant. Unknowns are T at the nodes (surface and back are nodes) and the extents xi_j
of the elements, in the order T_0, xi_0j, T_1, xi_1j, ..., T_N. Rates are integrated over an
element by Gauss's rule of two points, heat capacities are lumped at the nodes:

    dxi_j/dt = 1/2 sum_q k_j(T_q) m_formed (m/m_formed)^n
    C_n dT_n/dt = heat conducted and absorbed - sum_j dh_j r_j, weighted by the shape function of n

An element that has burnt keeps its residue; floors on its heat capacity and thermal resistance keep
the system regular where there is none. The foil belongs to the last node. Behind a contact
resistance it has a node of its own, and the contact is an element without mass between the two.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.reference.jacobian import banded_jacobian
from pyrofit.solver.reference.oxygen import rest_of_oxygen
from pyrofit.solver.reference.radiation import absorbed, top_average
from pyrofit.solver.reference.substance import COLDEST_K, HOTTEST_K, NumericSubstance
from pyrofit.solver.reference.surroundings import LinearPiece, Outside, ReferenceSurface, Rim

GAUSS = 0.5 - 0.5 / np.sqrt(3.0), 0.5 + 0.5 / np.sqrt(3.0)
"""Points of the rule of two points on (0, 1); both weigh 1/2."""
Air = tuple[FloatArray | float, FloatArray | float]
LEAST_LEFT = 1e-7
"""Heat capacity and thermal resistance of an element, relative to the initial, that never vanish.

Ten times as much changes the mass loss rate by 1e-5 of its mean without residue, and by 6e-6 and
2e-5 in the paper's case at 25 and 60 kW/m2.
"""
PERTURBED_K, PERTURBED_EXTENT = 1e-3, -1e-6
"""Differences for the Jacobian; extents go back, where there is something to react."""


@dataclass(frozen=True)
class Slab:
    """The constants of a run. Symbols: e element, n node, front first."""

    substance: NumericSubstance
    virgin: FloatArray
    """Initial mass fractions, shape (elements, components)."""
    mass: FloatArray
    """Initial masses [kg/m2], shape (elements,)."""
    sample: int
    """Number of elements of the sample; inert layers are behind it."""
    T_start: float
    front: ReferenceSurface
    back: ReferenceSurface
    back_emissivity: float
    foil_capacity: float
    """[J/(m2 K)]."""
    contact_resistance: float
    """Of the last element, if that has no mass [m2 K/W]."""
    back_absorbs: bool
    mixing_depth: float
    """[m]."""
    emissivity_change: float
    surface_share: float
    """Of the radiation, absorbed at the surface of a translucent sample."""
    gas_heat: float
    """Specific heat of the gas that flows to the front [J/(kg K)]."""
    rim: Rim

    @cached_property
    def stride(self) -> int:
        """Unknowns of a node and the element behind it; also the half width of the Jacobian."""
        return 1 + self.substance.reactions.A.size

    @cached_property
    def sample_mass(self) -> float:
        """Initial mass of the sample [kg/m2]."""
        return float(self.mass[: self.sample].sum())

    @cached_property
    def start(self) -> FloatArray:
        """The initial state."""
        y = np.zeros(self.mass.size * self.stride + 1)
        y[:: self.stride] = self.T_start
        return y

    @cached_property
    def least_capacity(self) -> FloatArray:
        """Heat capacity [J/(m2 K)] of the elements that never vanishes."""
        c = (self.virgin * self.substance.specific_heat.of(self._cold)).sum(axis=-1)
        return np.asarray(LEAST_LEFT * self.mass * c)

    @cached_property
    def least_resistance(self) -> FloatArray:
        """Thermal resistance [m2 K/W] of the elements that never vanishes."""
        volume = self._volume(self._cold, self.virgin * self.mass[:, None])
        out = LEAST_LEFT * self._d_k(self._cold, volume)
        out[self.mass == 0.0] = self.contact_resistance
        return out

    @cached_property
    def _cold(self) -> FloatArray:
        return np.full(self.mass.size, self.T_start)

    @cached_property
    def is_opaque(self) -> bool:
        """Whether radiation stops at the surface."""
        return not self.substance.absorption.any()

    def split(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return T (..., nodes) and extents (..., elements, reactions) of states (..., size)."""
        blocks = y[..., :-1].reshape(*y.shape[:-1], self.mass.size, self.stride)
        return y[..., :: self.stride], blocks[..., 1:]

    def masses(self, extent: FloatArray) -> FloatArray:
        """Return the masses of the components [kg/m2], shape (..., elements, components)."""
        share = self.virgin + linear.product(extent, self.substance.reactions.change)
        return np.asarray(share * self.mass[:, None])

    def _volume(self, T: FloatArray, present: FloatArray) -> FloatArray:
        """Return the volumes [m] of the masses ``present`` at T, shape (..., components)."""
        return np.asarray(present / self.substance.density * self.substance.expansion.of(T))

    def thickness(self, T: FloatArray, extent: FloatArray) -> FloatArray:
        """Return the thickness of the elements now [m], shape (..., elements)."""
        between = 0.5 * (T[..., :-1] + T[..., 1:])
        present = np.maximum(self.masses(extent), 0.0)
        return np.asarray(self._volume(between, present).sum(axis=-1))

    def radiating(self, volume: FloatArray, extent: FloatArray) -> float:
        """Return the emissivity, the average over the top ``mixing_depth`` of the sample now.

        It changes with the mass released over all. ``volume`` [m], shape (elements, components).
        """
        released = (
            linear.product(self.mass, linear.product(extent, self.substance.reactions.gas))
            / self.sample_mass
        )
        changed = self._topmost(volume) + self.emissivity_change * released
        return float(np.clip(changed, 0.0, 1.0))

    def _topmost(self, volume: FloatArray) -> float:
        if not volume.any():
            volume = self.virgin[0] / self.substance.density
            return float(linear.product(volume, self.substance.emissivity) / volume.sum())
        return top_average(volume, self.substance.emissivity, self.mixing_depth)

    def irradiated(self, radiation: float, volume: FloatArray, T: FloatArray) -> FloatArray:
        """Return the radiation [W/m2] that each node absorbs, shape (nodes,).

        The middles of the elements have the temperatures T [K].
        """
        if self.is_opaque:
            out = np.zeros(self.mass.size + 1)
            out[0] = radiation
            return out
        kappa = self.substance.absorption * self.substance.absorption_factor.of(T)
        entering = (1.0 - self.surface_share) * radiation
        out, passing = absorbed(entering, (volume * kappa).sum(axis=-1))
        out[0] += self.surface_share * radiation
        if self.back_absorbs:
            out[-1] += passing
        return out

    def outside(self, t: float, piece: LinearPiece, y: FloatArray) -> Outside:
        """Return the quantities that depend on time, or on the whole state at once."""
        T, extent = self.split(y)
        T = np.clip(T, COLDEST_K, HOTTEST_K)
        volume = np.maximum(self.masses(extent), 0.0) / self.substance.density
        eps = self.radiating(volume, extent)
        radiation = self.irradiated(eps * piece.at(t), volume, 0.5 * (T[:-1] + T[1:]))
        h, _ = self.front.convection(T[0], t, piece.span)
        air = self.air(T, extent, piece.oxygen, h)
        return Outside(t, eps, radiation, piece.span, self._passing(T, extent, air), air)

    def air(
        self, T: FloatArray, extent: FloatArray, oxygen: FloatArray | float, h: FloatArray
    ) -> Air:
        """Return the factors of the rates by the oxygen, of which the gas has the share given.

        ``oxygen`` is a number, or of shape (..., 1, 1), one for each state, and so is the heat
        transfer coefficient ``h`` of the front [W/(m2 K)].
        """
        reactions = self.substance.reactions
        if not reactions.oxygen_order.any():
            return 1.0, 1.0
        d = self.thickness(T, extent)
        front = np.cumsum(d, axis=-1) - d
        near, far = (reactions.at_depth(front + s * d, oxygen) for s in GAUSS)
        if not reactions.oxygen_use.any():
            return near, far
        reacting, _, _ = self._react(T[..., :-1], T[..., 1:], extent, (near, far))
        rate = (self.mass[:, None] * reacting).sum(axis=-2, keepdims=True)
        left = rest_of_oxygen(rate, oxygen, h, reactions)
        return near * left, far * left

    def _passing(self, T: FloatArray, extent: FloatArray, air: Air) -> FloatArray | float:
        """Return c_g G [W/(m2 K)] in the middle of the elements, G the gas flux to the front."""
        if self.gas_heat == 0.0:
            return 0.0
        reacting, _, _ = self._react(T[:-1], T[1:], extent, air)
        rate = self.mass * (linear.product(reacting, self.substance.reactions.gas))
        behind = np.cumsum(rate[::-1])[::-1] - rate
        return np.asarray(self.gas_heat * (behind + 0.5 * rate))

    def derivative(self, y: FloatArray, outside: Outside) -> FloatArray:
        """Return dy/dt of states of shape (..., size)."""
        T, extent = self.split(y)
        T = np.clip(T, COLDEST_K, HOTTEST_K)
        hot, cold = T[..., :-1], T[..., 1:]
        present = np.maximum(self.masses(extent), 0.0)
        reacting, upper, lower = self._react(hot, cold, extent, outside.air)
        between = 0.5 * (hot + cold)
        volume = self._volume(between, present)
        conducted = (hot - cold) / (self._d_k(between, volume) + self.least_resistance)
        gain = outside.absorbed + self._rim_gain(T, volume.sum(axis=-1))
        carried = 0.5 * outside.passing * (hot - cold)
        gain[..., :-1] -= conducted + upper + carried
        gain[..., 1:] += conducted - lower - carried
        gain[..., 0] += self.front.gain(outside.eps, T[..., 0], outside.t, outside.span)
        gain[..., -1] += self.back.gain(self.back_emissivity, T[..., -1], outside.t, outside.span)
        out = np.empty(y.shape)
        out[..., :: self.stride] = gain / self._capacity(T, present)
        self.split(out)[1][...] = reacting
        return out

    def heat_in(self, y: FloatArray, outside: Outside) -> float:
        """Return the heat [W/m2] that a state takes from its surroundings."""
        T, extent = self.split(y)
        gain = outside.absorbed + self._rim_gain(T, self.thickness(T, extent))
        gain[0] += self.front.gain(outside.eps, T[0], outside.t, outside.span)
        gain[-1] += self.back.gain(self.back_emissivity, T[-1], outside.t, outside.span)
        return float(gain.sum() - np.sum(outside.passing * (T[:-1] - T[1:])))

    def _rim_gain(self, T: FloatArray, d: FloatArray) -> FloatArray:
        """Return the heat from the edge to the nodes [W/m2]; inert layers behind have no edge."""
        return self.rim.gain(T, np.where(np.arange(self.mass.size) < self.sample, d, 0.0))

    def heat_taken(self, y_old: FloatArray, y: FloatArray) -> float:
        """Return the heat [J/m2] stored and used by reactions from one state to the next."""
        T, extent = self.split(np.stack((y_old, y)))
        capacity = self._capacity(T, np.maximum(self.masses(extent), 0.0)).mean(axis=0)
        reacted = linear.product(self.mass, extent[1] - extent[0])
        return float(
            linear.product(capacity, T[1] - T[0])
            + linear.product(reacted, self.substance.reactions.heat)
        )

    def _react(
        self, hot: FloatArray, cold: FloatArray, extent: FloatArray, air: Air
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return dxi/dt and the heat used [W/m2] that belongs to the upper and lower nodes."""
        reactions = self.substance.reactions
        amount = reactions.amounts(self.virgin, extent)
        near, far = (
            0.5 * reactions.rate_constants(hot + s * (cold - hot)) * of_oxygen
            for s, of_oxygen in zip(GAUSS, air, strict=True)
        )
        heat = self.mass[:, None] * amount * reactions.heat
        upper = ((GAUSS[1] * near + GAUSS[0] * far) * heat).sum(axis=-1)
        lower = ((GAUSS[0] * near + GAUSS[1] * far) * heat).sum(axis=-1)
        return amount * (near + far), upper, lower

    def _d_k(self, T: FloatArray, volume: FloatArray) -> FloatArray:
        """Return d/k [m2 K/W] of the elements, k mixed by volume."""
        d = volume.sum(axis=-1)
        k_d = (volume * self.substance.conductivity.of(T)).sum(axis=-1)
        return np.asarray(d * d / np.maximum(k_d, 1e-300))

    def _capacity(self, T: FloatArray, present: FloatArray) -> FloatArray:
        """Return the heat capacity [J/(m2 K)] of the nodes, half of each element beside them."""
        c = self.substance.specific_heat.of(T)
        out = np.zeros(T.shape)
        out[..., :-1] += (present * c[..., :-1, :]).sum(axis=-1) + self.least_capacity
        out[..., 1:] += (present * c[..., 1:, :]).sum(axis=-1) + self.least_capacity
        out *= 0.5
        out[..., -1] += self.foil_capacity
        return out

    def jacobian(self, y: FloatArray, outside: Outside) -> FloatArray:
        """Return d(dy/dt)/dy by differences, ``outside`` held, as `banded_jacobian` packs it."""
        change = np.full(y.size, PERTURBED_EXTENT)
        change[:: self.stride] = PERTURBED_K
        return banded_jacobian(lambda of: self.derivative(of, outside), y, change, self.stride)
