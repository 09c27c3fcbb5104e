"""A study of a laboratory that records mass and in-depth temperatures, through the workflow."""

import json
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from tiny import ROOT, TINY, Project

FOLDER = "results/tiny/diagnosis"
PLACES = {
    "tc_05mm": {"depth_m": 5e-4, "follows": "material"},
    "tc_15mm": {"depth_m": 1.5e-3, "follows": "fixture"},
}
FITTED = ["mass", *PLACES]
TRUTH = {"T_p": 605, "E_p": 190, "rho": 1190, "k": 0.2, "m_zero": 0.4}


def described() -> dict[str, Any]:
    """Return the tiny study with other records; the conductivity falls, the load cell is off."""
    study: dict[str, Any] = json.loads(json.dumps(TINY))
    every = {"file": "synthetic", "every": 5}
    signals: dict[str, Any] = {"mass": {**every, "noise": 5e-3, "offset": "m_zero"}}
    for name, place in PLACES.items():
        signals[name] = {"quantity": "in_depth_temperature", **every, **place, "noise": 1.0}
    study["parameters"]["m_zero"] = {"unit": "kg/m2", "lower": -1, "upper": 1}
    study["synthetic"]["truth"] = TRUTH
    study["synthetic"]["effects"] = {"k_T": {"slope_1_K": -1e-3}}
    for name in ("slab_60", "slab_80"):
        study["experiments"][name]["signals"] = signals
    study["imp"]["estimate"] = ["rho", "k", "m_zero"]
    term = {"experiment": "slab_60", "kind": "RMSE", "normalisation": "mean"}
    study["imp"]["costs"] = {"both": [{**term, "signal": signal} for signal in FITTED]}
    study["diagnosis"] = {
        "calibrate": {"slab_60": FITTED},
        "hold_out": {"slab_80": ["mass", "tc_05mm"]},
        "effects": ["k_T", "c_T", "swelling"],
    }
    del study["steps"]
    return study


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a finished diagnosis."""
    project = Project.copy(ROOT, tmp_path_factory.mktemp("probes") / "project")
    project.write(described())
    run = project.snakemake("--cores", "2", "diagnose")
    assert run.code == 0, run.said
    return project.root / FOLDER


def test_mass_and_two_temperatures_tell_what_the_model_lacks(folder: Path) -> None:
    log = (folder.parent / "logs" / "diagnosis.log").read_text(encoding="utf-8")
    assert "The model lacks: conductivity with temperature" in log


def test_truth_and_the_zero_of_the_load_cell_are_found(folder: Path) -> None:
    found = pd.read_csv(folder / "tables" / "parameters.csv", index_col="parameter")
    for name, truth in TRUTH.items():
        low, high = found.loc[name, ["extended_low", "extended_high"]]
        width = high - low
        assert low - 0.5 * width <= truth <= high + 0.5 * width, name
    assert found.loc["m_zero", "extended"] == pytest.approx(TRUTH["m_zero"], abs=0.005)


def test_every_quantity_has_its_figure(folder: Path) -> None:
    drawn = {path.name for path in folder.glob("*.png")}
    assert {"mass_per_area.png", "in-depth_temperature.png", "next_experiments.png"} <= drawn
