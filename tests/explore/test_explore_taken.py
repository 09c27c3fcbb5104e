"""What the explorer takes from a published material to start from."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from published_material import (
    VARYING,
    Change,
    kinetics_alone,
    of_thermal,
    published,
    second_reaction,
    single,
)

from pyrofit.constants import GAS_CONSTANT
from pyrofit_compare.published import material_in
from pyrofit_explore.model import ExploredModel
from pyrofit_explore.session import Session, State
from pyrofit_explore.taken import what_can_be_taken

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"


def test_a_set_that_is_taken_whole_has_its_published_curves(session: Session) -> None:
    one = published()
    values, said = what_can_be_taken(session.base, one)
    T = 190e3 / (GAS_CONSTANT * math.log(1e13 / 0.001))
    expected = {"T_p": T, "E_p": 190, "rho": 1190, "k": 0.21, "cp": 2.1, "eps": 0.88, "dh": 800}
    assert values == pytest.approx(expected)
    assert said.startswith("MaCFP: Polymer. Taken: T_p ")
    assert "rho 1190 kg/m3" in said
    assert said.endswith("Not taken: nothing.")
    base = session.base
    there = replace(base, problem=replace(base.problem, material=material_in(session.study, one)))
    here = session.simulate(State(values))[1]
    for a, b in zip(there.simulate({}).models, here.models, strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-6, atol=1e-9)


def test_values_are_clipped_to_limits_and_that_is_told(session: Session) -> None:
    values, said = what_can_be_taken(session.base, published(of_thermal("Emissivity", single(0.3))))
    assert values["eps"] == 0.5
    assert "eps 0.5, a limit (0.3 there)" in said


@pytest.mark.parametrize(
    ("change", "left", "words"),
    [
        (of_thermal("Conductivity", VARYING), {"k"}, "k (varies with temperature there)"),
        (kinetics_alone, {"rho", "k", "cp", "eps", "dh"}, "(kinetics alone there)"),
        (second_reaction, {"T_p", "E_p", "dh"}, "T_p, E_p, dh (1 reactions here, 2 there)"),
    ],
    ids=["curve", "kinetics", "scheme"],
)
def test_what_is_not_taken_is_told(
    session: Session, change: Change, left: set[str], words: str
) -> None:
    values, said = what_can_be_taken(session.base, published(change))
    assert set(session.base.problem.names) - set(values) == left
    assert words in said.split("Not taken:")[1]


def test_nothing_can_be_taken(session: Session) -> None:
    values, said = what_can_be_taken(session.base, published(second_reaction, kinetics_alone))
    assert values == {}
    assert "Taken: nothing." in said


def of_material(session: Session, changes: Mapping[str, Mapping[str, object]]) -> ExploredModel:
    """Return the study with numbers of its material replaced."""
    keys = yaml.safe_load(SMOKE.read_text())["material"]
    for part, new in changes.items():
        keys[part]["pyrolysis" if part == "reactions" else "polymer"].update(new)
    material = session.study.material.model_validate(keys)
    study = session.study.model_copy(update={"material": material})
    return replace(session.base, study=study)


def test_a_parameter_within_a_curve_or_an_expression_is_not_taken(session: Session) -> None:
    table = {"temperature_K": [300, 600], "value": [1000, 2000], "factor": "eps"}
    changes = {"specific_heat_J_kgK": table, "conductivity_W_mK": "0.5 * k", "emissivity": 0.9}
    values, said = what_can_be_taken(of_material(session, {"components": changes}), published())
    assert "k, eps (part of a curve or an expression here)" in said
    assert {"k", "eps"}.isdisjoint(values)


def test_a_parameter_of_two_numbers_that_differ_there_is_not_taken(session: Session) -> None:
    model = of_material(session, {"components": {"conductivity_W_mK": "eps"}})
    values, said = what_can_be_taken(model, published())
    assert "eps (several values there)" in said
    assert "eps" not in values


def test_a_pre_exponential_factor_is_taken_as_it_is(session: Session) -> None:
    kinetics = {"reference_temperature_K": None, "reference_rate_1_s": None, "A_1_s": "rho"}
    model = of_material(session, {"reactions": kinetics, "components": {"density_kg_m3": 1.0}})
    values, said = what_can_be_taken(model, published())
    assert values["rho"] == 1500.0
    assert "a limit (1e+13 there)" in said
