"""Curves that FDS 6.7.4 and 6.11.1 made of such decks, against pyrofit."""

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import pytest
from bases import Base, having
from decks import base, deck_of, predicted

from pyrofit.experiments import Tga
from pyrofit.model.accuracy import Accuracy
from pyrofit_exchange.fds.agreement import Agreement, heated_agreement, levels, slab_agreement
from pyrofit_exchange.fds.export import slab_curve
from pyrofit_exchange.fds.predicted import predict_heated

HERE = Path(__file__).parent / "data" / "fds"
VALUES = {
    "T_A": 581.8906935350835,
    "E_A": 215167.17879332782,
    "T_B": 614.836122962015,
    "E_B": 259950.99129426872,
    "w_A": 0.35185740879999594,
    "rho_a": 1182.3054202452672,
    "k_a": 0.15549973564788244,
    "cp_a": 2328.482142498946,
    "eps_a": 0.9899999989773448,
    "dh": 757258.4870561231,
}
FIVE = {
    "k_T": {"slope_1_K": -0.0012},
    "c_T": {"slope_1_K": 0.0015},
    "char_layer": {"yield": 0.08},
    "consecutive": {"yield": 0.15},
    "reaction_order": {"order": 1.4},
}


class Case(NamedTuple):
    """A stored curve, its experiment, effects, and the largest rms over mean of the rate."""

    file: str
    experiment: str
    effects: dict[str, dict[str, float]]
    rate: float


CASES = [
    Case("pmma_25", "capa_25", {}, 7e-4),
    Case("pmma_60", "capa_60", {}, 3e-3),
    Case("pmma_60_fds6.11.1", "capa_60", {}, 2e-3),
    Case("extended_60", "capa_60", FIVE, 5e-3),
]


def fitted() -> Base:
    return replace(base(), values={**base().values, **VALUES})


def stored(file: str) -> pd.DataFrame:
    raw = pd.read_csv(HERE / f"{file}.csv.gz")
    time = raw["time_s"].to_numpy()
    frame = pd.DataFrame({"time_s": 0.5 * (time + np.append(time[0], time[:-1]))})
    frame["rate_kg_m2s"] = raw["mlr_kg_m2_s"]
    frame["back_K"] = raw["T_back_C"] + 273.15
    frame["mass_kg_m2"] = raw["mass_kg_m2"]
    return frame.iloc[1:].reset_index(drop=True)


def agreements(case: Case) -> list[Agreement]:
    of = having(fitted(), case.effects) if case.effects else fitted()
    like = predicted(of, case.experiment)
    deck = deck_of(of, case.experiment, like=like)
    return slab_agreement(stored(case.file), slab_curve(like), levels(deck))


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.file)
def test_a_slab_agrees_with_the_stored_curve(case: Case) -> None:
    found = agreements(case)
    assert {a.verdict for a in found} == {"agrees"}
    assert found[0].rms_over_mean < case.rate


def test_left_out_effects_would_be_seen() -> None:
    # The stored curve has five effects that this deck has not.
    case = CASES[-1]._replace(effects={})
    assert agreements(case)[0].verdict == "differs"


def test_a_tga_agrees_with_the_stored_curve() -> None:
    raw = pd.read_csv(HERE / "tga_100K.csv.gz")
    experiment = Tga(kind="tga", heating_rate_K_min=100.0)
    left = predict_heated(experiment, fitted().material, fitted().values, Accuracy())
    T = np.arange(300.0, 800.5, 1.0)
    fds = pd.DataFrame(
        {"temperature_K": raw["T_C"] + 273.15, "mass_fraction": raw["mass_fraction"]}
    )
    ours = pd.DataFrame({"temperature_K": T, "mass_fraction": left(T)})
    (found,) = heated_agreement(fds, ours, levels(deck_of(fitted(), "tga_100K")))
    assert found.verdict == "agrees"
    assert found.largest < 1e-4
