"""Materials, specimens and curves the verification tests share."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.constants import GAS_CONSTANT
from pyrofit.experiments import Gasification, Tga
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_gasification, simulate_tga
from pyrofit.solver.curves import Curves, Place, Request
from pyrofit.solver.outputs import INSIDE

DATA = Path(__file__).parents[1] / "stored"

NAMES = ("rho_a", "k_a", "cp_a", "eps_a", "dh", "rho_r", "k_r", "cp_r", "eps_r")
TABLE_4 = {
    "RMSE": (1201.3, 0.1083, 2603.7, 0.9298, 669.2e3, 716.4, 0.2162, 787.3, 0.9871),
    "RANGE": (1200.5, 0.1075, 2592.0, 0.9322, 676.6e3, 897.1, 0.2053, 797.0, 0.9837),
    "BANDS": (1194.8, 0.1160, 2657.5, 0.9451, 675.2e3, 797.3, 0.1871, 805.6, 0.9867),
}
"""The paper's best sets, SI units."""
BEST = dict(zip(NAMES, TABLE_4["RMSE"], strict=True))

KINETICS = {
    "A": {"A_1_s": 9.98e4, "E_J_mol": 6.24e4},
    "B": {"A_1_s": 1.0e11, "E_J_mol": 1.6e5},
}
"""The paper's Table 3."""

E_SCALE = GAS_CONSTANT / 8.314
"""Gpyro's R is rounded; E/R shall be the same."""

FAINT = 1e-6
"""Emissivity so small that a slab absorbs q from a flux q/FAINT but emits next to nothing."""

NO_SIGNAL: dict[str, Any] = {"mlr": {"file": "synthetic"}}

Curve = np.ndarray[tuple[int], np.dtype[np.float64]]


def paper_material(residue_yield: float = 1e-3, share: float = 0.025, **virgin: Any) -> Material:
    """Table 3's reactions, Table 4's parameters by name; ``virgin`` replaces properties."""
    component = {
        "density_kg_m3": "rho_a",
        "conductivity_W_mK": "k_a",
        "specific_heat_J_kgK": "cp_a",
        "emissivity": "eps_a",
    } | virgin
    residue = {
        "density_kg_m3": "rho_r",
        "conductivity_W_mK": "k_r",
        "specific_heat_J_kgK": "cp_r",
        "emissivity": "eps_r",
    } | {key: value for key, value in virgin.items() if key == "absorption_1_m"}
    reactions = {
        name: {
            "reactant": name,
            "products": {"residue": residue_yield},
            "heat_of_reaction_J_kg": "dh",
            **kinetics,
        }
        for name, kinetics in KINETICS.items()
    }
    return Material.model_validate(
        {
            "components": {"A": component, "B": component, "residue": residue},
            "reactions": reactions,
            "composition": {"A": share, "B": "rest"},
        }
    )


def paper_experiment(
    flux_kW_m2: float,
    foil_m: float | None = 2e-4,
    cell_size_factor: float = 0.05,
    insulated: bool = False,
) -> Gasification:
    """The paper's 5.8 mm specimen with the boundary conditions of its FDS runs (S2)."""
    foil = {"thickness_m": foil_m, "density_kg_m3": 8940.0, "specific_heat_J_kgK": 380.0}
    emissivity = 0.9 if foil_m else "eps_a"
    back = {"h_cube_root_W_m2K43": 1.31, "emissivity": emissivity}
    return Gasification.model_validate(
        {
            "kind": "gasification",
            "sample": {
                "layers": [{"thickness_m": 5.8e-3}],
                "foil": foil if foil_m else None,
                "emissivity_depth": {"cell_size_factor": cell_size_factor},
            },
            "front": {"flux_W_m2": 1e3 * flux_kW_m2, "h_W_m2K": 4.0},
            "back": {} if insulated else back,
            "signals": NO_SIGNAL,
        }
    )


def inert_material(
    density: float = 1200.0,
    conductivity: Any = 0.2,
    specific_heat: Any = 1500.0,
    emissivity: float = 1.0,
    absorption: float | None = None,
) -> Material:
    """One component that does not react."""
    return Material.model_validate(
        {
            "components": {
                "solid": {
                    "density_kg_m3": density,
                    "conductivity_W_mK": conductivity,
                    "specific_heat_J_kgK": specific_heat,
                    "emissivity": emissivity,
                    "absorption_1_m": absorption,
                }
            },
            "composition": {"solid": 1.0},
        }
    )


def slab_experiment(
    thickness_m: float,
    front: Mapping[str, Any],
    back: Mapping[str, Any] | None = None,
    **sample: Any,
) -> Gasification:
    """One layer between a front and a back."""
    return Gasification.model_validate(
        {
            "kind": "gasification",
            "sample": {"layers": [{"thickness_m": thickness_m}], **sample},
            "front": {"flux_W_m2": 0.0, **front},
            "back": back or {},
            "signals": NO_SIGNAL,
        }
    )


Probes = tuple[float | Place, ...]
"""Depths [m] of temperatures that follow the material, or places."""


def placed(requests: Mapping[str, Request], probes_m: Probes) -> dict[str, Request]:
    """Requests with those for ``probe_0`` ... at the places given."""
    probes = {
        f"probe_{n}": at if isinstance(at, Place) else Place(at) for n, at in enumerate(probes_m)
    }
    return {
        name: replace(r, output=INSIDE, place=probes[name]) if name in probes else r
        for name, r in requests.items()
    }


def run(
    experiment: Gasification,
    material: Material,
    requests: Mapping[str, Request],
    accuracy: Accuracy | None = None,
    values: Mapping[str, float] = BEST,
    probes_m: Probes = (),
) -> Curves:
    """Simulate and demand a finished run whose mass closes."""
    asked = placed(requests, probes_m)
    curves = simulate_gasification(experiment, material, values, asked, accuracy)
    assert curves.status.finished, curves.status.explanation
    assert curves.mass_error <= 1e-12
    return curves


def powder(names: str, composition: dict[str, Any], *reactions: dict[str, Any]) -> Material:
    """Components of which the reactions alone matter."""
    component = {"density_kg_m3": 1e3, "conductivity_W_mK": 0.2, "specific_heat_J_kgK": 1e3}
    return Material.model_validate(
        {
            "components": dict.fromkeys(names, component),
            "reactions": {str(j): reaction for j, reaction in enumerate(reactions)},
            "composition": composition,
        }
    )


def table_3() -> Material:
    """The paper's Table 3 with its residue of a thousandth."""
    reactions = ({"reactant": name, "products": {"C": 1e-3}, **KINETICS[name]} for name in KINETICS)
    return powder("ABC", {"A": 0.025, "B": "rest"}, *reactions)


def tga_fraction(
    material: Material,
    rate_K_min: float,
    temperature_K: Curve,
    accuracy: Accuracy | None = None,
) -> Curve:
    """Mass fraction at ascending temperatures under a constant heating rate."""
    experiment = Tga.model_validate(
        {
            "kind": "tga",
            "heating_rate_K_min": rate_K_min,
            "signals": {"mass_fraction": {"file": "synthetic"}},
        }
    )
    time = (temperature_K - temperature_K[0]) * 60.0 / rate_K_min
    request = Request(time, temperature_K=temperature_K)
    curves = simulate_tga(experiment, material, {}, request, accuracy)
    assert curves.status.finished
    return curves.signals["mass_fraction"]


def reference(code: str, case: str) -> pd.DataFrame:
    """A curve of ``tests/stored/<code>``."""
    return pd.read_csv(DATA / code / f"{case}.csv", comment="#")


def rms_over_mean(curve: Curve, other: Curve) -> float:
    """Root mean square of the difference over the mean of ``other``."""
    return float(np.sqrt(np.mean((curve - other) ** 2)) / np.mean(other))


def burn_out(time: Curve, mlr: Curve, level: float = 1e-3) -> float:
    """Last time [s] at which the mass loss rate falls through ``level`` [kg/(m2 s)]."""
    n = int(np.flatnonzero(mlr > level)[-1])
    share = (mlr[n] - level) / (mlr[n] - mlr[n + 1])
    return float(time[n] + share * (time[n + 1] - time[n]))
