"""Water that a slab gives off, as its temperatures show it."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from pyrofit.config import Study, as_study
from pyrofit.results.files import Results
from pyrofit.show.water import lacking_water
from pyrofit.steps.preview.drying import held_up, held_up_of
from pyrofit.steps.preview.record import HeldUp, Preview, read, write

SECONDS = np.linspace(0.0, 1500.0, 1501)
MOIST_K = np.interp(SECONDS, [0.0, 300.0, 700.0, 1500.0], [300.0, 375.0, 395.0, 600.0])

HELD = HeldUp(experiment="slab", signal="back_temperature", temperature_K=385.0)
FOUND = Preview(sets=1, unfinished={}, windows=[], nearest=[], far=False, causes=[], unmoved=[])


def given(share: float | str = 0.0, yields: float | str = 0.2) -> dict[str, Any]:
    """Return a study of a charring board, whose layer has a share of water."""
    part = {"density_kg_m3": 400, "conductivity_W_mK": 0.1, "specific_heat_J_kgK": 1500}
    dries = {"reactant": "water", "reference_temperature_K": "T_w", "reference_rate_1_s": 0.001}
    chars = {"reactant": "wood", "products": {"char": yields}, "A_1_s": 1e13}
    free = {"T_w": {"unit": "K", "lower": 320.0, "upper": 400.0}}
    free |= {"w": {"unit": "-", "lower": 0.0, "upper": 0.1}} if share == "w" else {}
    free |= {"y": {"unit": "-", "lower": 0.0, "upper": 0.09}} if yields == "y" else {}
    layer = {"thickness_m": 0.02, "composition": {"wood": "rest", "water": share}}
    return {
        "name": "board",
        "seed": 1,
        "parameters": {**free, **({"dry": {"unit": "-", "value": 0.0}} if share == "dry" else {})},
        "material": {
            "components": dict.fromkeys(("wood", "char", "water"), part),
            "reactions": {
                "drying": {**dries, "E_J_mol": 88e3},
                "pyrolysis": {**chars, "E_J_mol": 180e3},
            },
            "composition": {"wood": 1.0},
        },
        "experiments": {
            "slab": {
                "kind": "gasification",
                "sample": {"layers": [layer]},
                "front": {"flux_W_m2": 30000},
                "signals": {},
                "repeats": [{"signals": {"back_temperature": f"{n}.csv"}} for n in "ab"],
            }
        },
        "imp": {
            "estimate": list(free),
            "kinetics": "described",
            "repetitions": 1,
            "costs": {
                "RMSE": [{"experiment": "slab", "signal": "back_temperature", "kind": "RMSE"}]
            },
        },
        "validation": {"experiments": ["slab"]},
    }


def found(described: dict[str, Any]) -> list[tuple[str, str, float]]:
    study: Study = as_study(described, "board.json")
    frame = pd.DataFrame({"time_s": SECONDS, "back_temperature_K": MOIST_K})
    records = {(name, "back_temperature"): frame for name in study.experiments}
    return list(held_up_of(study, records))


@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_slow_rise_near_100_degrees_is_found(noise: float) -> None:
    scatter = noise * np.random.default_rng(1).standard_normal(SECONDS.size)
    at = held_up(SECONDS, MOIST_K + scatter)
    assert at is not None
    assert 375.0 < at < 395.0


@pytest.mark.parametrize(
    "temperature",
    {
        "steady": 300.0 + 0.2 * SECONDS,
        "slower and slower": 300.0 + 300.0 * (1.0 - np.exp(-SECONDS / 400.0)),
        "faster and faster": 300.0 + 300.0 * (SECONDS / 1500.0) ** 3,
        "held up elsewhere": np.interp(SECONDS, [0, 300, 700, 1500], [300, 435, 455, 600]),
        "cold": 300.0 + 0.01 * SECONDS,
    }.values(),
    ids=["steady", "slower", "faster", "elsewhere", "cold"],
)
def test_other_courses_show_no_water(temperature: np.ndarray) -> None:
    assert held_up(SECONDS, temperature) is None


@pytest.mark.parametrize("share", [0.0, "dry"])
def test_water_that_the_model_lacks_is_told_once_for_all_repeats(share: float | str) -> None:
    assert found(given(share)) == [("slab", "back_temperature", 385.0)]


@pytest.mark.parametrize("share", [0.08, "w"])
def test_model_with_water_is_not_accused(share: float | str) -> None:
    assert found(given(share)) == []


def test_material_without_char_is_not_accused() -> None:
    assert found(given(0.0, yields="y")) == []


def test_finding_is_a_sentence_with_the_way_out() -> None:
    made = FOUND.model_copy(update={"held_up": [HELD]})
    assert lacking_water(made).startswith("slab: near 112 °C the temperature rises more slowly")
    assert lacking_water(made.model_copy(update={"held_up": []})) == ""


@pytest.mark.parametrize("held", [[], [HELD]])
def test_finding_is_read_as_it_was_written(held: list[HeldUp], tmp_path: Path) -> None:
    made = FOUND.model_copy(update={"held_up": held})
    write(Results(tmp_path), made)
    assert read(Results(tmp_path)) == made
    text = (tmp_path / "preview" / "preview.json").read_text("utf-8")
    assert ("held_up" in text) == bool(held)
