"""Char of a slab that burns after flame-out: named where it is hidden, and no claim without it."""

from typing import Any

import pytest

from pyrofit.config import Study, as_study
from pyrofit.diagnose.diagnosis import diagnose
from pyrofit.stages.measurements import computed

CHAR = {"density_kg_m3": 110, "specific_heat_J_kgK": 1200, "emissivity": 0.95}
WOOD = {"density_kg_m3": 500, "specific_heat_J_kgK": 1800, "emissivity": 0.9}
SIGNALS = {
    "mlr": {"file": "synthetic", "every": 5, "average_s": 5, "noise": 3e-4},
    "back_temperature": {"file": "synthetic", "every": 10, "noise": 2.0},
}
SURROUNDINGS = {"h_W_m2K": 12, "gas_temperature_K": 320, "wall_temperature_K": 300}
PARAMETERS = {
    "T": ("K", 560, 680, "reference temperature"),
    "E": ("kJ/mol", 100, 250, "activation energy"),
    "nu": ("-", 0.05, 0.4, "char yield"),
    "k": ("W/(m K)", 0.08, 0.4, "conductivity"),
    "k_char": ("W/(m K)", 0.05, 0.4, "conductivity of the char"),
    "dh": ("kJ/kg", 50, 1200, "heat of reaction"),
}


def cone(flux_W_m2: float, ignition_s: float, ends_s: float) -> dict[str, Any]:
    return {
        "kind": "cone",
        "title": "cone",
        "duration_s": 1500,
        "oxygen": 0.209,
        "sample": {"layers": [{"thickness_m": 0.008}], "initial_temperature_K": 298},
        "front": {"flux_W_m2": flux_W_m2, **SURROUNDINGS},
        "flame": {"ignition_s": ignition_s, "ends_s": ends_s, "flux_W_m2": 12000},
        "signals": SIGNALS,
    }


def study(effects: dict[str, Any]) -> Study:
    """Return a study that fits a cone test at 50 kW/m2, and predicts one at 35 kW/m2."""
    given = {
        "name": "char",
        "title": "Char in air",
        "description": "A slab that leaves char.",
        "seed": 5,
        "parameters": {
            name: dict(zip(("unit", "lower", "upper", "label"), of, strict=True))
            for name, of in PARAMETERS.items()
        },
        "known": {
            "T": {"value": 620, "sd": 4, "source": "TGA"},
            "E": {"value": 160, "sd": 6, "source": "TGA"},
            "nu": {"value": 0.22, "sd": 0.01, "source": "TGA"},
        },
        "material": {
            "components": {
                "wood": {**WOOD, "conductivity_W_mK": "k"},
                "char": {**CHAR, "conductivity_W_mK": "k_char"},
            },
            "reactions": {
                "pyrolysis": {
                    "reactant": "wood",
                    "products": {"char": "nu"},
                    "reference_temperature_K": "T",
                    "reference_rate_1_s": 0.001,
                    "E_J_mol": "E",
                    "heat_of_reaction_J_kg": "dh",
                }
            },
            "composition": {"wood": 1.0},
        },
        "experiments": {"cone_50": cone(5e4, 20, 320), "cone_35": cone(3.5e4, 45, 430)},
        "imp": {
            "estimate": list(PARAMETERS),
            "costs": {
                "RMSE": [{"experiment": "cone_50", "signal": s, "kind": "RMSE"} for s in SIGNALS]
            },
            "repetitions": 1,
        },
        "validation": {"experiments": ["cone_35"]},
        "diagnosis": {},
        "synthetic": {
            "truth": {"T": 620, "E": 160, "nu": 0.22, "k": 0.15, "k_char": 0.12, "dh": 300},
            "effects": effects,
        },
    }
    return as_study(given, "char.yaml")


@pytest.mark.parametrize(
    ("hidden", "kind"),
    [
        ({"char_oxidation": {"rate_1_s": 3e-3, "E_J_mol": 1.2e5, "heat_J_kg": -2e7}}, "named"),
        ({}, "none"),
    ],
    ids=["hidden", "none"],
)
def test_burning_char_of_a_slab_is_named(hidden: dict[str, Any], kind: str) -> None:
    truth = study(hidden)
    verdict = diagnose(truth, computed(truth, fast=True)).verdict
    assert (verdict.kind, list(verdict.effects)) == (kind, list(hidden))
