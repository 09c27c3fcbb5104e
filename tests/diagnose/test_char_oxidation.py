"""Char that burns in TGA in air: named where it is hidden, and no candidate in nitrogen."""

from typing import Any

import pytest

from pyrofit.config import Study, as_study, candidate_effects
from pyrofit.diagnose.diagnosis import diagnose
from pyrofit.stages.measurements import computed

AIR = 0.209
TGA = {"kind": "tga", "start_temperature_K": 450, "end_temperature_K": 900, "title": "TGA"}
SIGNALS = {"mass_fraction": {"file": "synthetic", "every": 3, "noise": 0.003}}
OTHERS = {"conductivity_W_mK": 0.2, "specific_heat_J_kgK": 1500, "emissivity": 0.9}
OXIDATION = {"rate_1_s": 4e-3, "E_J_mol": 1.2e5}


def study(effects: dict[str, Any], oxygen: float) -> Study:
    """Return a study that fits 5 K/min in a gas, 10 K/min in nitrogen, and predicts 20 K/min."""
    gases = {5: oxygen, 10: 0.0, 20: oxygen}
    fitted = [
        {"experiment": name, "signal": "mass_fraction", "kind": "RMSE"}
        for name in ("tga_5", "tga_10")
    ]
    given = {
        "name": "char",
        "title": "Char in air",
        "description": "A reaction that leaves char.",
        "seed": 5,
        "parameters": {
            "T": {"unit": "K", "lower": 560, "upper": 660, "label": "reference temperature"},
            "E": {"unit": "kJ/mol", "lower": 100, "upper": 300, "label": "activation energy"},
            "nu": {"unit": "-", "lower": 0.0, "upper": 0.5, "label": "char yield"},
        },
        "material": {
            "components": {name: {"density_kg_m3": 1200, **OTHERS} for name in ("wood", "char")},
            "reactions": {
                "pyrolysis": {
                    "reactant": "wood",
                    "products": {"char": "nu"},
                    "reference_temperature_K": "T",
                    "reference_rate_1_s": 0.001,
                    "E_J_mol": "E",
                }
            },
            "composition": {"wood": 1.0},
        },
        "experiments": {
            f"tga_{rate}": {**TGA, "heating_rate_K_min": rate, "oxygen": X, "signals": SIGNALS}
            for rate, X in gases.items()
        },
        "imp": {"estimate": ["T", "E", "nu"], "costs": {"RMSE": fitted}, "repetitions": 1},
        "validation": {"experiments": ["tga_20"]},
        "diagnosis": {},
        "synthetic": {"truth": {"T": 605, "E": 190, "nu": 0.25}, "effects": effects},
    }
    return as_study(given, "char.yaml")


def test_hidden_oxidation_is_named() -> None:
    truth = study({"char_oxidation": OXIDATION}, AIR)
    verdict = diagnose(truth, computed(truth)).verdict
    assert (verdict.kind, list(verdict.effects)) == ("named", ["char_oxidation"])


@pytest.mark.parametrize("hidden", [{}, {"reaction_order": {"order": 1.4}}])
def test_oxidation_is_not_named_where_it_is_not_hidden(hidden: dict[str, Any]) -> None:
    truth = study(hidden, AIR)
    assert "char_oxidation" in candidate_effects(truth)
    verdict = diagnose(truth, computed(truth)).verdict
    assert list(verdict.effects) == list(hidden)


def test_oxidation_is_a_candidate_in_a_gas_with_oxygen_alone() -> None:
    assert "char_oxidation" not in candidate_effects(study({}, 0.0))
    assert "char_oxidation" in candidate_effects(study({}, AIR))
