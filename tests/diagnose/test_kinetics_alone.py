"""The diagnosis of kinetics alone: TGA at several heating rates, without a slab."""

from typing import Any

import pytest

from pyrofit.config import Study, as_study
from pyrofit.diagnose.diagnosis import diagnose
from pyrofit.stages.measurements import computed

TGA = {"kind": "tga", "start_temperature_K": 450, "end_temperature_K": 750}
SIGNALS = {"mass_fraction": {"file": "synthetic", "every": 2, "noise": 0.003}}
FITTED = [
    {"experiment": name, "signal": "mass_fraction", "kind": "RMSE"} for name in ("tga_5", "tga_20")
]
OTHERS = {"conductivity_W_mK": 0.2, "specific_heat_J_kgK": 1500, "emissivity": 0.9}


def study(effects: dict[str, Any]) -> Study:
    """Return a study that fits 5 and 20 K/min and predicts 50 K/min."""
    given = {
        "name": "alone",
        "title": "Kinetics alone",
        "description": "One reaction of first order.",
        "seed": 3,
        "parameters": {
            "T": {"unit": "K", "lower": 560, "upper": 660, "label": "reference temperature"},
            "E": {"unit": "kJ/mol", "lower": 100, "upper": 300, "label": "activation energy"},
        },
        "material": {
            "components": {name: {"density_kg_m3": 1200, **OTHERS} for name in ("solid", "rest_")},
            "reactions": {
                "pyrolysis": {
                    "reactant": "solid",
                    "products": {"rest_": 0.01},
                    "reference_temperature_K": "T",
                    "reference_rate_1_s": 0.001,
                    "E_J_mol": "E",
                }
            },
            "composition": {"solid": 1.0},
        },
        "experiments": {
            f"tga_{rate}": {**TGA, "heating_rate_K_min": rate, "title": "TGA", "signals": SIGNALS}
            for rate in (5, 20, 50)
        },
        "imp": {"estimate": ["T", "E"], "costs": {"RMSE": FITTED}, "repetitions": 1},
        "validation": {"experiments": ["tga_50"]},
        "diagnosis": {},
        "synthetic": {"truth": {"T": 605, "E": 190}, "effects": effects},
    }
    return as_study(given, "alone.yaml")


@pytest.mark.parametrize(
    ("hidden", "strength"),
    [
        ("reaction_order", {"order": 1.4}),
        ("third_reaction", {"rate_1_s": 3e-4}),
        ("volatile", {"share": 0.02}),
        ("tga_lag", {"time_s": 8.0}),
    ],
)
def test_hidden_effect_is_named(hidden: str, strength: dict[str, float]) -> None:
    truth = study({hidden: strength})
    verdict = diagnose(truth, computed(truth)).verdict
    assert (verdict.kind, verdict.effects) == ("named", [hidden])


def test_nothing_is_named_where_nothing_is_hidden() -> None:
    truth = study({})
    assert diagnose(truth, computed(truth)).verdict.kind == "none"


@pytest.mark.long
def test_a_second_component_is_named_with_the_form_that_looks_alike() -> None:
    truth = study({"second_component": {"share": 0.3}})
    verdict = diagnose(truth, computed(truth)).verdict
    assert verdict.kind == "named"
    assert verdict.groups == ["reactions"]
    assert "second component" in verdict.forms[0]
