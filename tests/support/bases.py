"""Base models without any effect, and their curves."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter

from pyrofit.config import read_mapping
from pyrofit.effects.apply import with_effects
from pyrofit.effects.base import Effect
from pyrofit.experiments import AnyExperiment, Gasification, Tga
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_gasification, simulate_tga
from pyrofit.solver.curves import Curves, Request

PMMA = Path(__file__).parents[2] / "config" / "pmma.yaml"
PMMA_VALUES = {
    "T_A": 480.0,
    "E_A": 6.24e4,
    "T_B": 597.0,
    "E_B": 1.6e5,
    "w_A": 0.025,
    "rho_a": 1200.0,
    "k_a": 0.19,
    "cp_a": 2000.0,
    "eps_a": 0.9,
    "dh": 8e5,
}
END_S = {25e3: 1400.0, 60e3: 400.0}
CURVES = ("MLR 25", "MLR 60", "T_back 25", "T_back 60", "TGA 10", "TGA 100")

Curve = np.ndarray[tuple[int], np.dtype[np.float64]]
Numbers = Mapping[str, Mapping[str, float | str]]


@dataclass(frozen=True)
class Base:
    """A material, experiments by name, and the values of their parameters."""

    material: Material
    experiments: dict[str, Experiment]
    values: dict[str, float]


def pmma() -> Base:
    """Two components that react to the same residue, a foil, an open back."""
    keys = read_mapping(PMMA)
    names = ("capa_25", "capa_60", "tga_10K", "tga_100K")
    # As described, but opaque, and without a heat capacity that has a glass transition already.
    # Air acts on effects that need oxygen alone.
    exact = {"uncertain": None, "oxygen": 0.209}
    experiments = {n: {**keys["experiments"][n], **exact} for n in names}
    for name in ("tga_10K", "tga_100K"):
        del experiments[name]["temperature_offset_K"]
    components = {n: c for n, c in keys["material"]["components"].items() if n != "wool"}
    for of in components.values():
        of.pop("absorption_1_m", None)
        if not isinstance(of["specific_heat_J_kgK"], float | int):
            of["specific_heat_J_kgK"] = "cp_a"
    material = Material.model_validate({**keys["material"], "components": components})
    described = TypeAdapter(dict[str, AnyExperiment]).validate_python(experiments)
    return Base(material, described, PMMA_VALUES)


def wood() -> Base:
    """One component, whose char turns into ash; properties that depend on temperature; no foil."""
    component: dict[str, Any] = {
        "density_kg_m3": 600.0,
        "conductivity_W_mK": {"value": "k_w", "exponent": 0.6},
        "specific_heat_J_kgK": 1500.0,
    }
    char = component | {"density_kg_m3": 150.0}
    heat = {"heat_of_reaction_J_kg": 3e5}
    material = {
        "components": {"wood": component, "char": char, "ash": char},
        "reactions": {
            "burn_off": {
                "reactant": "char",
                "products": {"ash": 0.3},
                "A_1_s": 2e9,
                "E_J_mol": 2e5,
            },
            "pyrolysis": {
                "reactant": "wood",
                "products": {"char": 0.25},
                "reference_temperature_K": 600.0,
                "reference_rate_1_s": 2e-3,
                "E_J_mol": 1.5e5,
            }
            | heat,
        },
        "composition": {"wood": 1.0},
    }
    slab = {
        "kind": "gasification",
        "oxygen": 0.209,
        "sample": {"layers": [{"thickness_m": 0.004}]},
        "back": {"h_W_m2K": 5.0},
        "signals": {"mlr": {"file": "synthetic"}},
    }
    tga = {"kind": "tga", "oxygen": 0.209, "signals": {"mass_fraction": {"file": "synthetic"}}}
    fluxes = {"flux_25": 25e3, "flux_60": 60e3}
    slabs = {
        n: Gasification.model_validate(slab | {"front": {"flux_W_m2": q, "h_W_m2K": 10.0}})
        for n, q in fluxes.items()
    }
    tgas = {f"tga_{b}": Tga.model_validate(tga | {"heating_rate_K_min": b}) for b in (10, 100)}
    return Base(Material.model_validate(material), slabs | tgas, {"k_w": 0.15})


def run(base: Base, name: str) -> tuple[Curves, list[Curve]]:
    """Return the run of an experiment, and its curves."""
    experiment = base.experiments[name]
    if isinstance(experiment, Tga):
        temperature = np.arange(300.0, 900.0, 2.0)
        time = (temperature - 300.0) * 60.0 / experiment.heating_rate_K_min
        request = Request(time, temperature_K=temperature)
        curves = simulate_tga(experiment, base.material, base.values, request)
        return curves, list(curves.signals.values())[:1]
    flux = experiment.front.flux_W_m2
    assert isinstance(flux, float)
    at = np.arange(2.5, END_S[flux], 5.0)
    requests = {"mlr": Request(at, 5.0), "back_temperature": Request(at)}
    curves = simulate_gasification(experiment, base.material, base.values, requests)
    assert curves.status.finished, curves.status.explanation
    return curves, list(curves.signals.values())


def curves_of(base: Base) -> dict[str, Curve]:
    """Return all curves of a base."""
    low, high, slow, fast = (run(base, name)[1] for name in base.experiments)
    return dict(zip(CURVES, (low[0], high[0], low[1], high[1], slow[0], fast[0]), strict=True))


def having(base: Base, chosen: Numbers, **values: float) -> Base:
    material, experiments = with_effects(base.material, base.experiments, chosen)
    return replace(base, material=material, experiments=experiments, values=base.values | values)


def changes(curves: dict[str, Curve], other: dict[str, Curve]) -> dict[str, float]:
    return {
        n: float(np.sqrt(np.mean((curves[n] - other[n]) ** 2)) / np.mean(other[n])) for n in other
    }


def assert_same(curves: dict[str, Curve], other: dict[str, Curve]) -> None:
    for name in other:
        np.testing.assert_array_equal(curves[name], other[name], err_msg=name)


def strength(effect: Effect) -> str:
    (name,) = effect.strength
    return name
