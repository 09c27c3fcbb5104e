"""Heat conduction without reactions against exact solutions."""

from typing import Any

import numpy as np
import pytest
from cases import Curve, inert_material, run, slab_experiment
from scipy.optimize import brentq, fsolve

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.simulate import Accuracy
from pyrofit.solver.curves import Curves, Request

RHO, K, C, T0, DEPTH = 1200.0, 0.2, 1500.0, 293.15, 5.8e-3
FAINT = 1e-6
"""Emissivity so small that the slab absorbs q from a flux q/FAINT but emits next to nothing."""


def heated(absorbed: float, time: Curve, accuracy: Accuracy | None = None) -> Curves:
    """An insulated slab that absorbs a constant flux [W/m2] and emits nothing."""
    requests = {f"{side}_temperature": Request(time) for side in ("front", "back")}
    experiment = slab_experiment(DEPTH, {"flux_W_m2": absorbed / FAINT})
    return run(experiment, inert_material(emissivity=FAINT), requests, accuracy, {})


def flux_errors(accuracy: Accuracy | None) -> Curve:
    """Relative errors of the front's rise; the back is not yet felt."""
    time = np.array([2.0, 5.0, 10.0, 20.0, 30.0])
    rise = heated(25e3, time, accuracy).signals["front_temperature"] - T0
    exact: Curve = rise / (2.0 * 25e3 * np.sqrt(time / (np.pi * K * RHO * C))) - 1.0
    return exact


def test_constant_flux_heats_a_deep_body_with_the_square_root_of_time() -> None:
    # Measured: 5.8e-3 at 2 s, 1.8e-3 at 10 s, 0.9e-3 at 30 s by default.
    assert np.abs(flux_errors(None)) == pytest.approx([0.0] * 5, abs=0.008)
    assert np.abs(flux_errors(None)[2:]).max() <= 0.003


def test_constant_flux_error_vanishes_with_the_grid_and_the_tolerance() -> None:
    # Measured: 2.5e-4 at 2 s, 3e-5 at 30 s.
    found = np.abs(flux_errors(Accuracy(cells=200, tolerance=1e-5)))
    assert found[0] <= 4e-4
    assert found[-1] <= 5e-5


def heisler_errors(accuracy: Accuracy | None) -> Curve:
    """Largest error [K] from 1 s to 900 s of front and back; 200 K step, Bi = 2.9."""
    h, gas, diffusivity = 100.0, 493.15, K / (RHO * C)
    biot = h * DEPTH / K
    z = np.array(
        [
            brentq(lambda x: x * np.sin(x) - biot * np.cos(x), n * np.pi, n * np.pi + 0.5 * np.pi)
            for n in range(200)
        ]
    )
    weight = 4.0 * np.sin(z) / (2.0 * z + np.sin(2.0 * z))
    time = np.array([1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 200.0, 300.0, 500.0, 900.0])
    fading = np.exp(-np.outer(time, z * z) * diffusivity / DEPTH**2)
    requests = {"front_temperature": Request(time), "back_temperature": Request(time)}
    experiment = slab_experiment(DEPTH, {"h_W_m2K": h, "gas_temperature_K": gas})
    curves = run(experiment, inert_material(emissivity=0.0), requests, accuracy, {})
    front = gas - (gas - T0) * fading @ (weight * np.cos(z))
    back = gas - (gas - T0) * fading @ weight
    return np.array(
        [
            np.abs(curves.signals["front_temperature"] - front).max(),
            np.abs(curves.signals["back_temperature"] - back).max(),
        ]
    )


def test_convective_heating_follows_heislers_series() -> None:
    # Measured: 0.28 K (front, at 1 s) and 0.16 K (back) of 200 K by default.
    assert heisler_errors(None).max() <= 0.4


def test_convective_heating_converges_to_heislers_series() -> None:
    # Measured: 0.010 K and 0.001 K of 200 K.
    assert heisler_errors(Accuracy(cells=200, tolerance=1e-5)).max() <= 0.015


def test_beer_lambert_heating_without_conduction_is_exact() -> None:
    # Measured: 1.5e-6 in every cell, 2e-7 for the foil behind.
    cells, kappa, flux = 50, 1000.0, 25e3
    edges = DEPTH / cells * np.arange(cells + 1)
    intensity = flux * np.exp(-kappa * edges)
    time = np.array([0.5, 2.0])
    names = [f"probe_{n}" for n in range(cells)]
    requests = {name: Request(time) for name in (*names, "back_temperature")}
    foil = {"thickness_m": 2.5e-5, "density_kg_m3": 8960.0, "specific_heat_J_kgK": 385.0}
    curves = run(
        slab_experiment(DEPTH, {"flux_W_m2": flux / FAINT}, foil=foil),
        inert_material(conductivity=1e-9, emissivity=FAINT, absorption=kappa),
        requests,
        values={},
        probes_m=tuple(0.5 * (edges[1:] + edges[:-1])),
    )
    rise = np.array([curves.signals[name] - T0 for name in names])
    exact = np.outer(-np.diff(intensity) / (RHO * C * DEPTH / cells), time)
    assert rise == pytest.approx(exact, rel=1e-5)
    behind = curves.signals["back_temperature"] - T0
    assert behind == pytest.approx(intensity[-1] * time / 86.24, rel=1e-5)


def test_insulated_slab_keeps_the_heat_it_absorbs() -> None:
    # Parabolic profile about the mean q t/(rho c L). Measured: 0.004 K of 575 K, energy 1e-10.
    flux, time = 2e3, np.array([1000.0, 2000.0, 3000.0])
    curves = heated(flux, time)
    mean = T0 + flux * time / (RHO * C * DEPTH)
    front = mean + flux * DEPTH / (3.0 * K)
    back = mean - flux * DEPTH / (6.0 * K)
    assert curves.signals["front_temperature"] == pytest.approx(front, abs=0.01)
    assert curves.signals["back_temperature"] == pytest.approx(back, abs=0.01)
    assert curves.energy_error <= 1e-9
    assert curves.mass_error == 0.0


@pytest.mark.parametrize("cells", [50, 400])
def test_steady_state_balances_conduction_radiation_and_convection(cells: int) -> None:
    # k(T) linear, so conduction is k at the mean temperature. Measured: 1e-6 K.
    slope, length = 1.5e-3, DEPTH

    def imbalance(T: Any) -> list[float]:
        front, back = T
        k = K * (1.0 + slope * (0.5 * (front + back) - 300.0))
        conduction = k * (front - back) / length
        gain = 0.9 * (25e3 + STEFAN_BOLTZMANN * (290.0**4 - front**4)) - 8.6 * (front - 330.0)
        radiation = 0.8 * STEFAN_BOLTZMANN * (back**4 - 293.15**4)
        loss = radiation + (2.0 + 1.31 * (back - 300.0) ** (1.0 / 3.0)) * (back - 300.0)
        return [gain - conduction, conduction - loss]

    front = {
        "flux_W_m2": 25e3,
        "h_W_m2K": 8.6,
        "gas_temperature_K": 330.0,
        "wall_temperature_K": 290.0,
    }
    back = {
        "h_W_m2K": 2.0,
        "h_cube_root_W_m2K43": 1.31,
        "gas_temperature_K": 300.0,
        "emissivity": 0.8,
    }
    late = Request(np.array([1e4]))
    curves = run(
        slab_experiment(length, front, back),
        inert_material(conductivity={"value": K, "slope_1_K": slope}, emissivity=0.9),
        {"front_temperature": late, "back_temperature": late},
        Accuracy(cells=cells),
        {},
    )
    exact = fsolve(imbalance, [700.0, 550.0], xtol=1e-13)
    found = [curves.signals[f"{side}_temperature"][0] for side in ("front", "back")]
    assert found == pytest.approx(exact.tolist(), abs=1e-4)
