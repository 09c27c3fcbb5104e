"""FDS with an absorption coefficient: another equation

pyrofit lets external radiation fade with exp(-κ x) and emits from the surface, as Gpyro does. FDS
6.7.4 with ABSORPTION_COEFFICIENT solves a two-flux equation of diffuse radiation: inward and
outward flux F± change by dF±/dx = ∓2 κ (F± - σ T⁴), the solid emits throughout, and the surface
reflects part of the outward flux inwards, F⁺(0) = ε q + (1 - ε) F⁻(0), where ε F⁻(0) leaves. With
equal κ the two programs therefore differ by 12 %.

The two-flux equation, integrated here independently of both programs, gives FDS's curve. What a
description can say comes near: absorption with 2 κ, and a conductivity of 4 σ T³/κ on top of k.
"""

from typing import Any, NamedTuple

import numpy as np
from cases import BEST, KINETICS, Curve, burn_out, paper_experiment, paper_material, reference, run
from evidence import MLR, RMS_OVER_MEAN, TIME, Evidence, Line
from scipy.integrate import solve_ivp

from pyrofit.constants import GAS_CONSTANT
from pyrofit.constants import STEFAN_BOLTZMANN as SIGMA
from pyrofit.solver.curves import Request

KAPPA = 2870.0
FDS = "FDS 6.7.4"
LENGTH, AMBIENT, FLUX, H_FRONT, H_BACK, EPS_COPPER = 5.8e-3, 293.15, 25e3, 4.0, 1.31, 0.9
FOIL_J_m2K = 2e-4 * 8940.0 * 380.0
RESIDUE = 1e-3


def fds() -> tuple[Curve, Curve]:
    curve = reference("fds", "m_indepth2870")[1:]
    return curve["time_s"].to_numpy() - 0.5, curve["mlr_kg_m2_s"].to_numpy()


def sweep(start: float, optical_depth: Curve, emission: Curve) -> Curve:
    """A flux at the edges of cells that it crosses in their order; each absorbs and emits."""
    passed = np.exp(-np.concatenate([[0.0], np.cumsum(optical_depth)]))
    gained = -np.expm1(-optical_depth) * emission / passed[1:]
    flux: Curve = passed * (start + np.concatenate([[0.0], np.cumsum(gained)]))
    return flux


def net_radiation(d: Curve, T: Curve, foil: float, eps: float) -> Curve:
    """Inward less outward flux at the edges [W/m2], the outermost ones included."""
    depth, emission = 2.0 * KAPPA * d, SIGMA * T**4
    outward = sweep(SIGMA * foil**4, depth[::-1], emission[::-1])[::-1]
    start = eps * (FLUX + SIGMA * AMBIENT**4) + (1.0 - eps) * outward[0]
    return sweep(start, depth, emission) - outward


class Layer(NamedTuple):
    """Virgin material and residue of the cells [kg/m2], and what follows from them."""

    virgin: Curve
    residue: Curve
    d: Curve
    """Thickness [m]."""
    half: Curve
    """Thermal resistance of half a cell [m2 K/W]."""
    eps: float
    """Emissivity of the top that FDS's surface cell has at first."""


def layer(virgin: Curve, residue: Curve) -> Layer:
    v, v_r = virgin / BEST["rho_a"], residue / BEST["rho_r"]
    d = v + v_r
    delta = 0.05 * np.sqrt(BEST["k_a"] / (BEST["rho_a"] * BEST["cp_a"]))
    top = np.clip(delta - (np.cumsum(d) - d), 0.0, d) / d
    eps = (top @ (v * BEST["eps_a"] + v_r * BEST["eps_r"])) / (top @ d)
    half = 0.5 * d * d / (v * BEST["k_a"] + v_r * BEST["k_r"])
    return Layer(virgin, residue, d, half, float(eps))


def warming(cells: Layer, T: Curve, foil: float, used: Curve) -> Curve:
    """dT/dt [K/s] of the cells, then of the foil."""
    radiation = net_radiation(cells.d, T, foil, cells.eps)
    half = cells.half
    conduction = np.empty(T.size + 1)
    conduction[0] = (AMBIENT - T[0]) / (1.0 / H_FRONT + half[0])
    conduction[1:-1] = (T[:-1] - T[1:]) / (half[:-1] + half[1:])
    conduction[-1] = (T[-1] - foil) / half[-1]
    through = conduction + radiation
    capacity = cells.virgin * BEST["cp_a"] + cells.residue * BEST["cp_r"]
    warm = foil - AMBIENT
    loss = EPS_COPPER * SIGMA * (foil**4 - AMBIENT**4) + H_BACK * abs(warm) ** (1 / 3) * warm
    inside = (-np.diff(through) - BEST["dh"] * used) / capacity
    return np.append(inside, (through[-1] - loss) / FOIL_J_m2K)


def two_flux(time: Curve, cells: int = 40) -> Curve:
    """Mass loss rate averaged over 1 s about the times, by the two-flux equation."""
    start = BEST["rho_a"] * LENGTH / cells
    A, E = (np.array([[KINETICS[n][key]] for n in "AB"]) for key in ("A_1_s", "E_J_mol"))

    def rates(t: float, state: Any) -> Any:
        T, foil = state[:cells], state[cells]
        shares = state[cells + 1 : -1].reshape(2, cells)
        decay = A * np.exp(-E / (GAS_CONSTANT * T)) * shares
        used = start * decay.sum(axis=0)
        virgin = start * shares.sum(axis=0)
        solid = layer(virgin, RESIDUE * (start - virgin))
        released = (1.0 - RESIDUE) * used.sum()
        return np.concatenate([warming(solid, T, foil, used), -decay.ravel(), [released]])

    shares = np.repeat([0.025, 0.975], cells)
    initial = np.concatenate([np.full(cells + 1, AMBIENT), shares, [0.0]])
    edges = np.unique(np.concatenate([time - 0.5, time + 0.5]))
    solution = solve_ivp(
        rates, (0.0, edges[-1]), initial, "BDF", edges, rtol=1e-5, atol=1e-6, first_step=1e-3
    )
    assert solution.success
    released = solution.y[-1]
    return np.interp(time + 0.5, edges, released) - np.interp(time - 0.5, edges, released)


def ours(time: Curve, **virgin: Any) -> Curve:
    curves = run(paper_experiment(25.0), paper_material(**virgin), {"mlr": Request(time, 1.0)})
    return curves.signals["mlr"]


def test_the_two_flux_equation_is_that_of_fds(evidence: Evidence) -> None:
    time, mlr = fds()
    found = two_flux(time)
    gap = RMS_OVER_MEAN.of(found, mlr)
    title = f"25 kW/m², κ = {KAPPA:.0f} 1/m: two-flux equation, integrated (not pyrofit)"
    evidence.number(title, gap, 0.007, RMS_OVER_MEAN.name, FDS, "%")
    late = abs(burn_out(time, found) - burn_out(time, mlr))
    evidence.number(f"{title}: burn-out", late, 6.0, "difference", FDS, "s")


def test_beer_and_lambert_differ_from_two_fluxes(evidence: Evidence) -> None:
    time, mlr = fds()
    evidence.difference(
        f"25 kW/m², κ = {KAPPA:.0f} 1/m in both",
        TIME,
        MLR,
        Line(time, ours(time, absorption_1_m=KAPPA), mlr),
        FDS,
        (0.11, 0.13),
        "FDS absorbs diffuse radiation with 2 κ and exchanges radiation inside the solid.",
    )


def test_twice_kappa_and_rosselands_conductivity_come_near_fds(evidence: Evidence) -> None:
    time, mlr = fds()
    nodes = np.arange(290.0, 901.0, 10.0)
    k = BEST["k_a"] + 4.0 * SIGMA * nodes**3 / KAPPA
    table = {"temperature_K": nodes.tolist(), "value": k.tolist()}
    found = ours(time, absorption_1_m=2.0 * KAPPA, conductivity_W_mK=table)
    evidence.difference(
        f"25 kW/m², 2 κ and k + 4 σ T³/κ (κ = {KAPPA:.0f} 1/m)",
        TIME,
        MLR,
        Line(time, found, mlr),
        FDS,
        (0.01, 0.02),
        "What remains: FDS emits from a layer of about 1/(2 κ), pyrofit from the surface, which is "
        "7 K hotter in FDS.",
    )
