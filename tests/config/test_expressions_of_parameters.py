"""Parameters that are expressions of others, and parameters that are held at a value."""

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from pyrofit.config import Study, as_study
from pyrofit.config.uses import parameters_in
from pyrofit.errors import StudyError
from pyrofit.model.base import value_of
from pyrofit.results import dependencies

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
GIVEN: dict[str, Any] = yaml.safe_load(SMOKE.read_text(encoding="utf-8"))


def changed(**parameters: Any) -> dict[str, Any]:
    """Return the study with parameters added, and `c_r` as the residue's specific heat."""
    given = copy.deepcopy(GIVEN)
    given["parameters"] |= parameters
    given["material"]["components"]["residue"]["specific_heat_J_kgK"] = "c_r"
    return given


def c_r(text: str, unit: str = "J/(kg K)", **others: Any) -> dict[str, Any]:
    return changed(c_r={"unit": unit, "expression": text}, **others)


def heat_of_residue(study: Study, **values: float) -> Any:
    component = study.material.components["residue"]
    return value_of(component.specific_heat_J_kgK, values)


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("0.5 * cp", "kJ/(kg K)", 1000.0),
        ("500 * cp", "J/(kg K)", 1000.0),
        ("cp / (1 + eps) ** 2 + 0.25", "kJ/(kg K)", 750.0),
        ("max(0.4 * cp, sqrt(eps) - k)", "kJ/(kg K)", 800.0),
        ("2 * other", "J/(kg K)", 1000.0),
    ],
)
def test_expression_has_the_unit_of_its_parameter(text: str, unit: str, expected: float) -> None:
    other = {"unit": "J/(kg K)", "expression": "250 * cp"}
    given = c_r(text, unit, **({"other": other} if "other" in text else {}))
    values = {"cp": 2000.0, "eps": 1.0, "k": 1.0}
    assert heat_of_residue(as_study(given, "x.yaml"), **values) == pytest.approx(expected)


def test_study_with_an_expression_is_the_same_after_a_run_wrote_it() -> None:
    study = as_study(c_r("0.5 * cp", "kJ/(kg K)"), "x.yaml")
    assert "cp" in parameters_in(study.material)
    assert "c_r" not in parameters_in(study.material)
    again = as_study(json.loads(json.dumps(study.model_dump(mode="json"))), "x.json")
    assert again == study
    other = as_study(c_r("0.6 * cp", "kJ/(kg K)"), "x.yaml")
    assert dependencies.validation_slice(other) != dependencies.validation_slice(study)


def test_values_of_many_sets_are_those_of_each_to_the_last_bit() -> None:
    x, y = np.random.default_rng(1).lognormal(size=(2, 25))
    text = "x ** 1.7 / exp(-y) - log(x) * y"
    many = value_of(text, {"x": x, "y": y})
    alone = [value_of(text, {"x": a, "y": b}) for a, b in zip(x.tolist(), y.tolist(), strict=True)]
    np.testing.assert_array_equal(many, alone)


BAD: dict[str, tuple[dict[str, Any], str]] = {
    "unknown": (
        c_r("0.5 * E_pp"),
        "c_r.expression: unknown parameter 'E_pp'. Did you mean 'E_p'",
    ),
    "no arithmetic": (c_r("cp if k else 1"), "only numbers, parameters, + - * / ** and"),
    "attribute": (c_r("cp.__class__"), "only numbers, parameters"),
    "call": (c_r("open(cp)"), "unknown function 'open'"),
    "no expression": (c_r("0.5 *"), "'0.5 *' is no expression"),
    "itself": (c_r("c_r + cp"), "it leads back to itself: c_r -> c_r"),
    "endless": (c_r(" + ".join(["cp"] * 500)), "an expression of 2497 characters"),
    "infinite": (c_r("9 ** 9 ** 9 ** 9"), "has no value with these numbers"),
    "circle": (
        c_r("2 * a", a={"unit": "-", "expression": "b"}, b={"unit": "-", "expression": "c_r"}),
        "it leads back to itself: c_r -> a -> b -> c_r",
    ),
    "division by zero": (c_r("cp / (cp - 1)"), "has no value with cp = 1, as after a division"),
    "below 0": (
        c_r("cp - 2", "kJ/(kg K)"),
        "material.components.residue.specific_heat_J_kgK: -1000 must be above 0",
    ),
    "value as well": (
        changed(c_r={"unit": "J/(kg K)", "expression": "cp", "value": 1}),
        "an expression stands instead of value, limits and fixed",
    ),
}


@pytest.mark.parametrize(("given", "words"), BAD.values(), ids=BAD)
def test_wrong_expression_is_told_with_its_place(given: dict[str, Any], words: str) -> None:
    with pytest.raises(StudyError) as error:
        as_study(given, "x.yaml")
    assert words in str(error.value)


def test_estimated_expression_is_refused() -> None:
    given = c_r("500 * cp")
    given["imp"]["estimate"].append("c_r")
    with pytest.raises(StudyError, match="give lower and upper limits, not an expression"):
        as_study(given, "x.yaml")


def fix(given: dict[str, Any]) -> None:
    given["parameters"]["cp"]["fixed"] = 2.1


def known_and_fixed(given: dict[str, Any]) -> None:
    fix(given)
    given["known"] = {"cp": {"value": 2.0, "sd": 0.1}}


@pytest.mark.parametrize("change", [fix, known_and_fixed])
def test_one_key_holds_a_parameter_at_a_value(change: Callable[[dict[str, Any]], None]) -> None:
    given = copy.deepcopy(GIVEN)
    change(given)
    study = as_study(given, "x.yaml")
    assert study.fixed_values()["cp"] == pytest.approx(2100.0)
    assert study.imp.estimate == tuple(n for n in GIVEN["imp"]["estimate"] if n != "cp")
    assert study.known == {}
    again = as_study(json.loads(json.dumps(study.model_dump(mode="json"))), "x.json")
    assert again == study


def test_fixed_value_keeps_the_rules_of_its_place() -> None:
    given = copy.deepcopy(GIVEN)
    given["parameters"]["cp"]["fixed"] = -1.0
    with pytest.raises(StudyError, match=r"parameters.cp.fixed: -1.0 lies outside the limits 1 to"):
        as_study(given, "x.yaml")
    del given["parameters"]["cp"]["lower"], given["parameters"]["cp"]["upper"]
    with pytest.raises(StudyError, match=r"parameters.cp.value: -1.0 must be above 0"):
        as_study(given, "x.yaml")
