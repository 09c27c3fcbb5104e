"""Heat conduction against exact solutions

A slab of constant properties that does not react: ρ c ∂T/∂t = k ∂²T/∂x² (k = 0.2 W/(m K), ρ =
1200 kg/m³, c = 1500 J/(kg K), 5.8 mm). On 50 cells the differences are those of the grid in the
first seconds; on 200 cells with a tight tolerance they vanish. Solutions are derived in
`tests/verification/exact.py`; C&J is Carslaw & Jaeger, Conduction of Heat in Solids, 1959.
"""

from typing import Any

import numpy as np
import pytest
from cases import FAINT, Curve, inert_material, run, slab_experiment
from evidence import DEPTH as DEPTH_AXIS
from evidence import LARGEST_K, TEMPERATURE, TIME, Evidence, Line
from exact import convective_step, deep_body, deep_translucent_body, slab_with_foil
from scipy.optimize import fsolve

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.model.accuracy import Accuracy
from pyrofit.solver.curves import Curves, Request

RHO, K, C, T0, DEPTH = 1200.0, 0.2, 1500.0, 293.15, 5.8e-3
COARSE = Accuracy(cells=50, tolerance=2e-3)
FINE = Accuracy(cells=200, tolerance=1e-5)
COPPER = {"thickness_m": 2e-4, "density_kg_m3": 8940.0, "specific_heat_J_kgK": 380.0}
COPPER_J_m2K = 2e-4 * 8940.0 * 380.0
GRIDS = {"50 cells": COARSE, "200 cells": FINE}


def heated(
    absorbed: float,
    time: Curve,
    accuracy: Accuracy | None = None,
    probes_m: tuple[float, ...] = (),
    length: float = DEPTH,
    absorption: float | None = None,
    foil: dict[str, float] | None = None,
) -> Curves:
    """A slab with an insulated back that absorbs a constant flux [W/m2] and emits nothing."""
    names = [f"{side}_temperature" for side in ("front", "back")]
    names += [f"probe_{n}" for n in range(len(probes_m))]
    experiment = slab_experiment(length, {"flux_W_m2": absorbed / FAINT}, foil=foil)
    material = inert_material(emissivity=FAINT, absorption=absorption)
    requests = dict.fromkeys(names, Request(time))
    return run(experiment, material, requests, accuracy, {}, probes_m)


@pytest.mark.parametrize(("grid", "limit"), [("50 cells", 1.0), ("200 cells", 0.06)])
def test_constant_flux_heats_a_deep_body(evidence: Evidence, grid: str, limit: float) -> None:
    time = np.arange(2.0, 200.5, 2.0)
    depths = (0.0, 2e-3, 5e-3)
    curves = heated(5e3, time, GRIDS[grid], depths[1:], length=0.02)
    names = ("front_temperature", "probe_0", "probe_1")
    lines = {
        f"{1e3 * x:.0f} mm": Line(time, curves.signals[n], T0 + deep_body(5e3, K, RHO * C, x, time))
        for x, n in zip(depths, names, strict=True)
    }
    title = f"constant flux of 5 kW/m² into a deep body, {grid}"
    source = "exact: C&J ch. II, ierfc"
    evidence.curve(title, TIME, TEMPERATURE, lines, source, limit, LARGEST_K)


@pytest.mark.parametrize(("grid", "limit"), [("50 cells", 0.2), ("200 cells", 0.006)])
@pytest.mark.parametrize("foil", [False, True])
def test_constant_flux_heats_an_insulated_slab(
    evidence: Evidence, foil: bool, grid: str, limit: float
) -> None:
    time = np.geomspace(2.0, 500.0, 80)
    curves = heated(5e3, time, GRIDS[grid], foil=COPPER if foil else None)
    M = COPPER_J_m2K if foil else 0.0
    lines = {
        side: Line(
            time,
            curves.signals[f"{side}_temperature"],
            T0 + slab_with_foil(5e3, K, RHO * C, DEPTH, M, x, time),
        )
        for side, x in (("front", 0.0), ("back", DEPTH))
    }
    what = "on 0.2 mm copper" if foil else "with an insulated back"
    title = f"constant flux of 5 kW/m² into a slab {what}, {grid}"
    source = "exact: C&J ch. III, series with tan z = -z M/(ρ c L)"
    evidence.curve(title, TIME, TEMPERATURE, lines, source, limit, LARGEST_K)
    energy = f"{title}: energy"
    evidence.number(energy, curves.energy_error, 1e-9, "imbalance / heat absorbed", "balance")


@pytest.mark.parametrize(("grid", "limit"), [("50 cells", 0.4), ("200 cells", 0.015)])
def test_convective_heating_follows_heislers_series(
    evidence: Evidence, grid: str, limit: float
) -> None:
    h, gas = 100.0, 493.15
    time = np.geomspace(1.0, 900.0, 80)
    requests = {"front_temperature": Request(time), "back_temperature": Request(time)}
    experiment = slab_experiment(DEPTH, {"h_W_m2K": h, "gas_temperature_K": gas})
    curves = run(experiment, inert_material(emissivity=0.0), requests, GRIDS[grid], {})
    fourier = K / (RHO * C) / DEPTH**2 * time
    lines = {
        side: Line(
            time,
            curves.signals[f"{side}_temperature"],
            gas - (gas - T0) * convective_step(h * DEPTH / K, fourier, place),
        )
        for side, place in (("front", 1.0), ("back", 0.0))
    }
    title = f"convective heating by 200 K, Bi = 2.9, {grid}"
    source = "exact: C&J ch. III, series with z tan z = Bi"
    evidence.curve(title, TIME, TEMPERATURE, lines, source, limit, LARGEST_K)


@pytest.mark.parametrize(("grid", "limit"), [("50 cells", 0.4), ("200 cells", 0.03)])
def test_radiation_absorbed_in_depth_heats_a_deep_body(
    evidence: Evidence, grid: str, limit: float
) -> None:
    kappa, time = 1000.0, np.arange(2.0, 200.5, 2.0)
    depths = (0.0, 1e-3, 3e-3)
    curves = heated(5e3, time, GRIDS[grid], depths[1:], length=0.02, absorption=kappa)
    names = ("front_temperature", "probe_0", "probe_1")
    lines = {
        f"{1e3 * x:.0f} mm": Line(
            time,
            curves.signals[name],
            T0 + deep_translucent_body(5e3, kappa, K, RHO * C, x, time),
        )
        for x, name in zip(depths, names, strict=True)
    }
    title = f"flux absorbed in depth (κ = 1000 1/m) with conduction, {grid}"
    source = "exact: C&J ch. II, source κ q exp(-κ x)"
    evidence.curve(title, TIME, TEMPERATURE, lines, source, limit, LARGEST_K)


def test_beer_lambert_heating_without_conduction_is_exact(evidence: Evidence) -> None:
    cells, kappa, flux, time = 50, 1000.0, 25e3, 2.0
    edges = DEPTH / cells * np.arange(cells + 1)
    middles = 0.5 * (edges[1:] + edges[:-1])
    intensity = flux * np.exp(-kappa * edges)
    names = [f"probe_{n}" for n in range(cells)]
    foil = {"thickness_m": 2.5e-5, "density_kg_m3": 8960.0, "specific_heat_J_kgK": 385.0}
    foil["contact_m2K_W"] = 1e6
    curves = run(
        slab_experiment(DEPTH, {"flux_W_m2": flux / FAINT}, foil=foil),
        inert_material(conductivity=1e-4, emissivity=FAINT, absorption=kappa),
        {name: Request(np.array([time])) for name in (*names, "back_temperature")},
        values={},
        probes_m=tuple(middles),
    )
    ours = np.array([curves.signals[name][0] for name in names])
    exact = T0 - np.diff(intensity) / (RHO * C * DEPTH / cells) * time
    title = "flux absorbed in depth (κ = 1000 1/m) with next to no conduction, 2 s"
    line, source = Line(middles, ours, exact), "exact: Beer-Lambert in every cell"
    evidence.curve(title, DEPTH_AXIS, TEMPERATURE, line, source, 0.02, LARGEST_K)
    behind = curves.signals["back_temperature"][0] - T0
    gap = abs(behind / (intensity[-1] * time / 86.24) - 1.0)
    what = "radiation that passes the slab heats the foil"
    evidence.number(what, gap, 1e-5, "relative difference of the rise", "exact: Beer-Lambert")


@pytest.mark.parametrize("cells", [50, 400])
def test_steady_state_balances_conduction_radiation_and_convection(
    evidence: Evidence, cells: int
) -> None:
    slope = 1.5e-3

    def imbalance(T: Any) -> list[float]:
        front, back = T
        # k is linear in T, so conduction is that of k at the mean temperature.
        k = K * (1.0 + slope * (0.5 * (front + back) - 300.0))
        conduction = k * (front - back) / DEPTH
        gain = 0.9 * (25e3 + STEFAN_BOLTZMANN * (290.0**4 - front**4)) - 8.6 * (front - 330.0)
        radiation = 0.8 * STEFAN_BOLTZMANN * (back**4 - 293.15**4)
        loss = radiation + (2.0 + 1.31 * (back - 300.0) ** (1.0 / 3.0)) * (back - 300.0)
        return [gain - conduction, conduction - loss]

    gas, wall = {"gas_temperature_K": 330.0}, {"wall_temperature_K": 290.0}
    front = {"flux_W_m2": 25e3, "h_W_m2K": 8.6, **gas, **wall}
    around = {"gas_temperature_K": 300.0, "emissivity": 0.8}
    back = {"h_W_m2K": 2.0, "h_cube_root_W_m2K43": 1.31, **around}
    late = Request(np.array([1e4]))
    curves = run(
        slab_experiment(DEPTH, front, back),
        inert_material(conductivity={"value": K, "slope_1_K": slope}, emissivity=0.9),
        {"front_temperature": late, "back_temperature": late},
        Accuracy(cells=cells),
        {},
    )
    found = [curves.signals[f"{side}_temperature"][0] for side in ("front", "back")]
    gap = np.abs(np.array(found) - fsolve(imbalance, [700.0, 550.0], xtol=1e-13)).max()
    title = f"steady state between radiation and convection, k(T) linear, {cells} cells"
    source = "exact: two algebraic equations"
    evidence.number(title, float(gap), 1e-4, "larger difference of front and back", source, "K")
