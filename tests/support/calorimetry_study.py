"""A small study with simultaneous thermal analysis and combustion calorimetry.

Run: python tests/support/calorimetry_study.py > calorimetry.json

That file also predicts a slab without a measurement, for the gallery of the documentation.
"""

import json
from typing import Any

SLAB = {
    "kind": "gasification",
    "duration_s": 200,
    "sample": {"layers": [{"thickness_m": 0.002}]},
    "front": {"flux_W_m2": 60000, "h_W_m2K": 8},
    "signals": {"mlr": {"file": "synthetic", "every": 10, "average_s": 10, "noise": 2e-4}},
}
HEATED = {"start_temperature_K": 400, "end_temperature_K": 760}
RMSE = {"kind": "RMSE", "normalisation": "mean"}
STUDY: dict[str, Any] = {
    "name": "calorimetry",
    "seed": 5,
    "parameters": {
        "T_p": {"unit": "K", "lower": 580, "upper": 640},
        "E_p": {"unit": "kJ/mol", "lower": 120, "upper": 260},
        "dh": {"unit": "kJ/kg", "lower": 200, "upper": 1600},
        "c": {"unit": "J/(kg K)", "lower": 1000, "upper": 3000},
        "b_0": {"unit": "W/kg", "lower": -200, "upper": 200},
        "b_1": {"unit": "W/(kg K)", "lower": -1, "upper": 1},
        "h": {"unit": "kJ/kg", "lower": 10000, "upper": 40000},
        "tau": {"unit": "s", "lower": 0, "upper": 20},
        "rho": {"unit": "kg/m3", "lower": 900, "upper": 1500},
        "k": {"unit": "W/(m K)", "lower": 0.1, "upper": 0.4},
    },
    "material": {
        "components": {
            "polymer": {
                "density_kg_m3": "rho",
                "conductivity_W_mK": "k",
                "specific_heat_J_kgK": "c",
            },
            "char": {
                "density_kg_m3": 200,
                "conductivity_W_mK": 0.1,
                "specific_heat_J_kgK": 1300,
            },
        },
        "reactions": {
            "pyrolysis": {
                "reactant": "polymer",
                "products": {"char": 0.1},
                "reference_temperature_K": "T_p",
                "reference_rate_1_s": 0.001,
                "E_J_mol": "E_p",
                "heat_of_reaction_J_kg": "dh",
                "heat_of_combustion_J_kg": "h",
            }
        },
        "composition": {"polymer": 1.0},
    },
    "experiments": {
        "sta_10": {
            "kind": "dsc",
            "heating_rate_K_min": 10,
            "baseline": {"level_W_kg": "b_0", "slope_W_kgK": "b_1"},
            **HEATED,
            "signals": {
                "mass_fraction": {"file": "synthetic", "every": 2, "noise": 0.002},
                "heat_flow": {"file": "synthetic", "every": 3, "noise": 15.0},
            },
        },
        "mcc_60": {
            "kind": "mcc",
            "heating_rate_K_min": 60,
            "response_s": "tau",
            **HEATED,
            "signals": {
                "specific_heat_release_rate": {"file": "synthetic", "every": 2, "noise": 2e3}
            },
        },
        "slab_60": SLAB,
        "slab_80": {**SLAB, "front": {"flux_W_m2": 80000, "h_W_m2K": 8}},
    },
    "accuracy": {"cells": 10},
    "synthetic": {
        "truth": {
            "T_p": 605,
            "E_p": 190,
            "dh": 850,
            "c": 1900,
            "b_0": 60,
            "b_1": 0.3,
            "h": 24000,
            "tau": 6,
            "rho": 1190,
            "k": 0.2,
        },
        "accuracy": {"elements": 40, "tolerance": 1e-4},
    },
    "kinetics": {
        "estimate": ["T_p", "E_p", "dh", "c", "b_0", "b_1", "h", "tau"],
        "cost": [
            {"experiment": "sta_10", "signal": "mass_fraction", **RMSE},
            {"experiment": "sta_10", "signal": "heat_flow", **RMSE},
            {"experiment": "mcc_60", "signal": "specific_heat_release_rate", **RMSE},
        ],
        "sceua": {"complexes": 2, "generations": 3},
        "least_squares": {"starts": 2},
        "sets": {
            "known": {
                "reactions": {"pyrolysis": {"A_1_s": 2.5e13, "E_J_mol": 190e3}},
                "composition": {"polymer": 1.0},
            }
        },
    },
    "imp": {
        "estimate": ["rho", "k"],
        "kinetics": "fitted",
        "repetitions": 1,
        "sceua": {"complexes": 2, "generations": 3},
        "least_squares": {"starts": 1},
        "cmaes": {"starts": 1, "calls": 30},
        "costs": {
            "RMSE": [
                {"experiment": "slab_60", "signal": "mlr", "kind": "RMSE", "normalisation": "mean"}
            ]
        },
    },
    "validation": {"experiments": ["slab_60", "slab_80"]},
    "steps": {"robustness": {"noise": [1], "outliers": [0.1], "draws": 1, "starts": 1}},
}
"""STA at 10 K/min and MCC at 60 K/min determine kinetics and heats; a slab the rest."""


def with_prediction() -> dict[str, Any]:
    """Return the study with the prediction of a slab that was not measured."""
    kept = {key: value for key, value in SLAB.items() if key != "signals"}
    front = {"flux_W_m2": 100000, "h_W_m2K": 8}
    slab = {**kept, "title": "slab 100 kW/m²", "front": front, "predicts": ["mlr"]}
    return {**STUDY, "experiments": {**STUDY["experiments"], "slab_100": slab}}


if __name__ == "__main__":
    print(json.dumps(with_prediction(), indent=1))
