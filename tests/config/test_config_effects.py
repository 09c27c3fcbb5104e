"""Effects listed in a study."""

import json
from pathlib import Path
from typing import Any

import pytest
import yaml

from pyrofit.config import Study, as_study, diagnosed_parameters, digest
from pyrofit.effects import known_effects
from pyrofit.errors import StudyError
from pyrofit.model.properties import Changed

CONFIG = Path(__file__).parents[2] / "config"


def given(source: str = "smoke", /, **effects: Any) -> dict[str, Any]:
    study = yaml.safe_load((CONFIG / f"{source}.yaml").read_text(encoding="utf-8"))
    return {**study, "effects": effects}


def having(source: str = "smoke", /, **effects: Any) -> Study:
    return as_study(given(source, **effects), f"{source}.yaml")


def test_effect_with_a_number_changes_the_description() -> None:
    study = having(back_loss={"factor": 0.5})
    assert [e.back.loss_factor for n, e in study.experiments.items() if n.startswith("slab")] == [
        0.5,
        0.5,
    ]


def test_strength_left_out_is_a_parameter_with_the_limits_of_the_catalogue() -> None:
    study = given("pmma", k_T=None)
    study["imp"]["estimate"].append("k_T_slope_1_K")
    found = as_study(study, "pmma.yaml")
    assert found.parameters["k_T_slope_1_K"].bounds_si == (-2e-3, 5e-3)
    assert found.with_effects == {"k_T": {"slope_1_K": "k_T_slope_1_K"}}
    changed = found.material.components["B"].conductivity_W_mK
    assert isinstance(changed, Changed)
    assert (changed.of, changed.slope_1_K) == ("k_a", "k_T_slope_1_K")


def test_own_limits_come_before_those_of_the_catalogue() -> None:
    study = given("pmma", k_T=None)
    study["parameters"]["k_T_slope_1_K"] = {"unit": "1/K", "lower": -2e-4, "upper": 2e-4}
    study["imp"]["estimate"].append("k_T_slope_1_K")
    found = as_study(study, "pmma.yaml")
    assert found.parameters["k_T_slope_1_K"].bounds_si == (-2e-4, 2e-4)


def test_study_in_json_has_its_effects() -> None:
    study = as_study(given(back_loss={"factor": 0.5}), "mine.json")
    assert study.experiments["slab_25"].back.loss_factor == 0.5


KINETIC = {
    "char_layer",
    "char_oxidation",
    "consecutive",
    "reaction_order",
    "tga_lag",
    "tga_offset",
    "second_component",
    "third_reaction",
    "volatile",
}
"""Effects that TGA sees: they are estimated with the kinetics."""


@pytest.mark.parametrize("name", known_effects())
def test_every_effect_can_be_estimated(name: str) -> None:
    # Others have numbers of their own where effects of the apparatus set theirs.
    everywhere = known_effects()[name].is_shared or name == "tga_offset"
    own = {} if everywhere else {"laboratories": ["UMD", "UMET"]}
    # pmma describes a temperature offset and absorption in depth itself.
    described = name == "tga_offset" or name.startswith("in_depth")
    study = given("paper" if described else "pmma", **{name: own})
    for experiment in study["experiments"].values():
        experiment.pop("uncertain", None)
        if experiment["kind"] == "gasification" and name == "char_oxidation":
            experiment["oxygen"] = 0.21
    strengths = [f"{name}_{key}" for key in known_effects()[name].strength]
    study["kinetics" if name in KINETIC else "imp"]["estimate"] += strengths
    found = as_study(study, "pmma.yaml")
    assert set(strengths) <= set(found.parameters)


def test_strength_that_is_neither_given_nor_estimated_is_refused() -> None:
    with pytest.raises(StudyError, match="k_T_slope_1_K"):
        having(k_T={})


def test_written_study_is_read_again_unchanged() -> None:
    study = having(back_loss={"factor": 0.5}, c_T={"slope_1_K": 1e-3})
    text = study.model_dump_json()
    again = as_study(json.loads(text), "study.json")
    assert again == study
    assert digest(again.model_dump(mode="json")) == digest(study.model_dump(mode="json"))


def test_published_kinetics_keep_what_effects_add() -> None:
    study = having("paper", third_reaction={"rate_1_s": 3e-4})
    material = study.material_with("Table 3")
    assert set(material.reactions) == {"A", "B", "extra_reaction"}
    assert material.reactions["A"].A_1_s == 9.98e4


def test_published_kinetics_of_first_order_take_the_order_that_an_effect_sets() -> None:
    study = having("paper", reaction_order={"order": 1.4})
    reactions = study.material_with("Table 3").reactions
    assert {name: r.order for name, r in reactions.items()} == {"A": 1.0, "B": 1.4}
    assert reactions["B"].A_1_s == having("paper").material_with("Table 3").reactions["B"].A_1_s


def test_order_beside_published_kinetics_of_another_order_is_refused() -> None:
    study = given("paper", reaction_order={"order": 1.4})
    study["kinetics"]["sets"]["Table 3"]["reactions"]["B"]["order"] = 2.0
    with pytest.raises(StudyError, match=r"imp\.kinetics 'Table 3' brings an order of its own"):
        as_study(study, "paper.yaml")


def test_unknown_effect_that_a_model_is_said_to_have_is_refused() -> None:
    study = {**given(), "with_effects": {"back_los": {}}}
    with pytest.raises(StudyError, match=r"with_effects: unknown effect 'back_los'\. Did you mean"):
        as_study(study, "smoke.yaml")


@pytest.mark.parametrize(
    ("effects", "words"),
    [
        ({"back_los": {"factor": 0.5}}, "unknown effect 'back_los'. Did you mean 'back_loss'?"),
        ({"back_loss": {"facto": 0.5}}, "unknown parameter 'facto'. Did you mean 'factor'?"),
        ({"back_loss": {"factor": "half"}}, "unknown parameter 'half'"),
        ({"back_loss": {"factor": -1.0}}, "must not be negative"),
        ({"in_depth": {"length_m": 1e-3}, "in_depth_lost": {"length_m": 1e-3}}, "in_depth_lost"),
        ({"back_loss": 0.5}, "effects.back_loss"),
        ({"k_T": {"slope_1_K": "a b"}}, "neither a number nor the name of a parameter"),
        ({1: {}}, "unknown effect '1'"),
    ],
)
def test_broken_effect_is_refused_in_words(effects: dict[str, Any], words: str) -> None:
    study = {**given(), "effects": effects}
    with pytest.raises(StudyError) as error:
        as_study(study, "smoke.yaml")
    assert words in str(error.value)


def test_parameter_that_is_known_only_is_estimated_by_the_diagnosis() -> None:
    study = given()
    study["parameters"]["gauge"] = {"unit": "-", "value": 1.0, "lower": 0.9, "upper": 1.1}
    study["experiments"]["slab_25"]["front"]["flux_factor"] = "gauge"
    study["synthetic"]["truth"]["gauge"] = 1.0
    study["known"] = {"gauge": {"value": 1.0, "sd": 0.03}}
    found = as_study(study, "smoke.yaml")
    assert diagnosed_parameters(found)[-1] == "gauge"
    assert "gauge" not in found.imp.estimate
