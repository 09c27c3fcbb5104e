"""Tests at one heating rate tell no activation energy, however well a model fits them."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from line_model import TIME, WHITE, by_name, likelihood

from pyrofit.estimate.identify import identify
from pyrofit.estimate.one_rate import at_one_rate, following_from_the_model
from pyrofit.experiments import KINDS
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material
from pyrofit.results.goodness import ONE_RATE


def heated(rate: float, kind: str = "tga", **more: Any) -> Experiment:
    keys = {"kind": kind, "heating_rate_K_min": rate, "signals": {}} | more
    return KINDS[kind].description.model_validate(keys)


def slab() -> Experiment:
    keys = {"sample": {"layers": [{"thickness_m": 0.01}]}, "front": {"flux_W_m2": 25e3}}
    return KINDS["cone"].description.model_validate({"kind": "cone", "signals": {}} | keys)


def of_reaction(**numbers: Any) -> Material:
    component = {"density_kg_m3": 1e3, "conductivity_W_mK": 0.2, "specific_heat_J_kgK": 1e3}
    reaction = {"reactant": "virgin", "reference_temperature_K": "c", "reference_rate_1_s": 1e-3}
    return Material.model_validate(
        {
            "components": {"virgin": component},
            "reactions": {"pyrolysis": reaction | {"E_J_mol": "a"} | numbers},
            "composition": {"virgin": 1.0},
        }
    )


@pytest.mark.parametrize(
    ("experiments", "one"),
    [
        ([heated(10.0), heated(14.0, "mcc")], True),
        ([heated(10.0), heated(20.0)], False),
        ([heated(10.0), slab()], False),
        ([heated(10.0, set_point_K=600.0), heated(10.0, set_point_K=600.0)], True),
        ([heated(10.0, set_point_K=600.0), heated(10.0, set_point_K=620.0)], False),
        ([heated(10.0, set_point_K=600.0), heated(10.0)], False),
    ],
)
def test_one_rate_is_one_programme_of_heated_samples(
    experiments: list[Experiment], one: bool
) -> None:
    assert at_one_rate(experiments) is one


def test_energy_order_and_rate_follow_from_the_model_at_one_rate() -> None:
    problem: Any = SimpleNamespace(
        names=("a", "b", "c"),
        material=of_reaction(order="b"),
        runs={"tga": SimpleNamespace(experiment=heated(10.0))},
    )
    assert following_from_the_model(problem) == [0, 1]
    assert following_from_the_model(problem, known=[0]) == [1]
    problem.runs["faster"] = SimpleNamespace(experiment=heated(50.0))
    assert following_from_the_model(problem) == []


@pytest.mark.parametrize(("assumed", "rest"), [([0], {"a", "c"}), ([], set())])
def test_energy_of_one_rate_is_not_determined_nor_what_moves_with_it(
    monkeypatch: pytest.MonkeyPatch, assumed: list[int], rest: set[str]
) -> None:
    """b stands for a residue, which E hardly moves; c for a temperature of a rate off the peak."""
    monkeypatch.setattr(
        "pyrofit.estimate.identify.following_from_the_model", lambda problem, known: assumed
    )
    rows = np.column_stack([TIME, 3.0 * np.cos(9.0 * TIME), TIME + 0.05 * np.sin(20.0 * TIME)])
    value = rows @ [1.0, 1.0, 1.0] + 0.01 * WHITE
    found = by_name(
        identify(likelihood(lambda x: rows @ x, value, 0.01, ((0.0, 2.0),) * 3), [np.full(3, 0.5)])
    )
    assert {name for name, e in found.items() if e.verdict == ONE_RATE} == rest
    assert {e.verdict for name, e in found.items() if name not in rest} == {"determined"}
