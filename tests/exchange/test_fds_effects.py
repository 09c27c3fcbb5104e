"""Curves that FDS 6.7.4 made of single effects and of pairs at 60 kW/m2, against pyrofit.

The decks are of another writer, uniform cells, steps of 0.01 s; rates and temperatures are means
over 1 s, at their middle. Base sets near PMMA, 5.8 mm on 25 um of copper from 300 K.
"""

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from bases import Base, having
from decks import base, deck_of, predicted

from pyrofit.model.slab import SlabExperiment
from pyrofit_exchange.fds.agreement import levels, slab_agreement
from pyrofit_exchange.fds.export import slab_curve

HERE = Path(__file__).parent / "data" / "effects"
CASES: dict[str, dict[str, Any]] = json.loads((HERE / "cases.json").read_text())


@cache
def slab() -> SlabExperiment:
    other = base().experiments["capa_25"]
    assert isinstance(other, SlabExperiment)
    front = other.front.model_copy(update={"flux_W_m2": 60e3})
    sample = other.sample.model_copy(update={"initial_temperature_K": 300.0})
    return other.model_copy(update={"front": front, "sample": sample, "signals": {}})


@pytest.mark.parametrize("name", CASES)
def test_an_effect_agrees_with_the_stored_curve(name: str) -> None:
    case = CASES[name]
    of = having(Base(base().material, {"x": slab()}, case["values"]), case["effects"])
    like = predicted(of, "x")
    curve = slab_curve(like)
    stored = pd.read_csv(HERE / f"{name}.csv.gz").rename(
        columns={"mlr_kg_m2s": "rate_kg_m2s", "T_back_K": "back_K"}
    )
    start = np.interp(0.0, curve["time_s"], curve["mass_kg_m2"])
    stored["mass_kg_m2"] = start - stored["rate_kg_m2s"].cumsum()
    found = {
        a.signal: a
        for a in slab_agreement(stored, curve, levels(deck_of(of, "x", like=like)))
        if a.signal != "mass"
    }
    assert [a.verdict for a in found.values()] == ["agrees"] * 2
    assert found["mlr"].rms_over_mean < 4e-3
    assert found["back_temperature"].rms < 0.35
