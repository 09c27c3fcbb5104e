"""A cone test of known truth."""

from typing import Any

from pyrofit.config import Study, as_study

LIMITS = {
    "rho": ("kg/m3", 900, 1500),
    "k": ("W/(m K)", 0.1, 0.4),
    "dh": ("kJ/kg", 300, 1500),
    "dhc": ("kJ/kg", 15e3, 35e3),
    "q_flame": ("kW/m2", 0, 40),
    "ignition_35": ("s", 20, 150),
    "ignition_60": ("s", 10, 80),
}


TRUTH = {
    "rho": 1190.0,
    "k": 0.2,
    "dh": 800.0,
    "dhc": 24500.0,
    "q_flame": 16.0,
    "ignition_35": 71.0,
    "ignition_60": 28.0,
}


SIGNALS: dict[str, dict[str, Any]] = {
    "heat_release_rate": {"file": "synthetic", "every": 5, "average_s": 5, "noise": 6e3},
    "mass": {"file": "synthetic", "every": 5, "noise": 0.01},
}


def cone(flux_kW_m2: float, duration_s: float) -> dict[str, Any]:
    return {
        "kind": "cone",
        "duration_s": duration_s,
        "sample": {"layers": [{"thickness_m": 0.004}]},
        "front": {"flux_W_m2": 1e3 * flux_kW_m2, "h_W_m2K": 10},
        "flame": {"flux_W_m2": "q_flame", "ignition_s": f"ignition_{flux_kW_m2}"},
        "signals": SIGNALS,
    }


def study() -> Study:
    names = ("cone_35", "cone_60")
    given = {
        "name": "burning",
        "seed": 4,
        "parameters": {n: {"unit": u, "lower": a, "upper": b} for n, (u, a, b) in LIMITS.items()},
        "material": {
            "components": {
                "polymer": {
                    "density_kg_m3": "rho",
                    "conductivity_W_mK": "k",
                    "specific_heat_J_kgK": 2100,
                }
            },
            "reactions": {
                "pyrolysis": {
                    "reactant": "polymer",
                    "reference_temperature_K": 605,
                    "reference_rate_1_s": 0.001,
                    "E_J_mol": 190e3,
                    "heat_of_reaction_J_kg": "dh",
                    "heat_of_combustion_J_kg": "dhc",
                }
            },
            "composition": {"polymer": 1.0},
        },
        "experiments": {"cone_35": cone(35, 600), "cone_60": cone(60, 400)},
        "accuracy": {"cells": 25},
        "synthetic": {"truth": TRUTH, "accuracy": {"elements": 60}},
        "imp": {
            "estimate": list(LIMITS),
            "costs": {
                "RMSE": [{"experiment": "cone_60", "signal": "heat_release_rate", "kind": "RMSE"}]
            },
            "identification": {name: list(SIGNALS) for name in names},
        },
        "validation": {"experiments": ["cone_35"]},
    }
    return as_study(given, "burning.yaml")
