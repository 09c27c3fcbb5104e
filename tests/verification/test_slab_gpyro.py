"""The slab against Gpyro 0.82 on 201 nodes with steps of 0.1 s, first order in time.

Gpyro's heat of reaction is per kg of gas, so the inert 0.1 % is a third component, not a yield.
"""

from typing import Any

import numpy as np
import pytest
from cases import KINETICS, Curve, reference, rms_over_mean, run, slab_experiment

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model.experiment import Gasification
from pyrofit.model.material import Material
from pyrofit.solver.curves import Request

E_SCALE = GAS_CONSTANT / 8.314
"""Gpyro's R is rounded; E/R shall be the same."""
CONDITIONS: dict[str, dict[str, Any]] = {
    "base": {},
    "foil": {"foil": True},
    "hfront20": {"h_front": 20.0},
    "kT_n07": {"conductivity": {"value": 0.108, "exponent": 0.7}},
    "cpT_n05": {"specific_heat": {"value": 2600.0, "exponent": 0.5}},
    "back_insulated": {"insulated": True},
    "indepth_k1000_foil": {"absorption": 1000.0, "foil": True},
}


def material(
    conductivity: Any = 0.108, specific_heat: Any = 2600.0, absorption: float | None = None
) -> Material:
    component = {
        "density_kg_m3": 1201.0,
        "conductivity_W_mK": conductivity,
        "specific_heat_J_kgK": specific_heat,
        "emissivity": 0.93,
        "absorption_1_m": absorption,
    }
    reactions = {
        name: {
            "reactant": name,
            "A_1_s": KINETICS[name]["A_1_s"],
            "E_J_mol": KINETICS[name]["E_J_mol"] * E_SCALE,
            "heat_of_reaction_J_kg": 7e5,
        }
        for name in "AB"
    }
    return Material.model_validate(
        {
            "components": dict.fromkeys("ABR", component),
            "reactions": reactions,
            "composition": {"A": 0.024975, "B": 0.974025, "R": 0.001},
        }
    )


def experiment(
    flux_kW_m2: float, h_front: float = 8.6, foil: bool = False, insulated: bool = False
) -> Gasification:
    front = {
        "flux_W_m2": 1e3 * flux_kW_m2,
        "h_W_m2K": h_front,
        "gas_temperature_K": 330.0,
        "wall_temperature_K": 290.0,
    }
    back = {
        "h_W_m2K": 4.0,
        "gas_temperature_K": 300.0,
        "wall_temperature_K": 300.0,
        "emissivity": 0.93,
    }
    copper = {"thickness_m": 2.5e-5, "density_kg_m3": 8960.0, "specific_heat_J_kgK": 385.0}
    return slab_experiment(
        5.8e-3,
        front,
        {} if insulated else back,
        initial_temperature_K=300.0,
        foil=copper if foil else None,
    )


def simulate(name: str, flux_kW_m2: float, request: Request) -> Curve:
    changes = CONDITIONS[name]
    solid = ("conductivity", "specific_heat", "absorption")
    matter = material(**{key: value for key, value in changes.items() if key in solid})
    place = {key: value for key, value in changes.items() if key not in solid}
    curves = run(experiment(flux_kW_m2, **place), matter, {"mlr": request}, values={})
    return curves.signals["mlr"]


@pytest.mark.parametrize(
    "name",
    [
        "base",  # measured: 0.05 %
        "foil",  # 0.17 %
        "hfront20",  # 0.04 %
        "kT_n07",  # 0.03 %
        "cpT_n05",  # 0.05 %
        "back_insulated",  # 0.07 %
        "indepth_k1000_foil",  # 0.14 %
    ],
)
def test_25_kW_m2_follows_gpyro(name: str) -> None:
    curve = reference("gpyro", f"{name}_25")
    ours = simulate(name, 25.0, Request(curve["time_s"].to_numpy()))
    assert rms_over_mean(ours, curve["mlr_kg_m2_s"].to_numpy()) <= 0.003


@pytest.mark.parametrize("name", ["base", "foil"])
def test_60_kW_m2_follows_gpyro_in_bins_of_5_s(name: str) -> None:
    # Measured: base 0.39 %, foil 0.32 %. As point values 0.71 % and 0.41 %: 97 % of that squared
    # error lies in the last seconds, where the rate collapses and a shift of 0.15 s leaves 0.12 %.
    curve = reference("gpyro", f"{name}_60")
    time, mlr = curve["time_s"].to_numpy(), curve["mlr_kg_m2_s"].to_numpy()
    edges = np.arange(0.0, time[-1], 5.0)
    gas = np.append(0.0, np.cumsum(np.diff(time) * 0.5 * (mlr[1:] + mlr[:-1])))
    bins = np.diff(np.interp(edges, time, gas)) / 5.0
    ours = simulate(name, 60.0, Request(edges[1:] - 2.5, 5.0))
    assert rms_over_mean(ours, bins) <= 0.006
