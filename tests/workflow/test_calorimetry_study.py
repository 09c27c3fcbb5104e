"""A study with STA and combustion calorimetry through the workflow, its diagnosis included."""

import copy
import json
from typing import Any

import pytest
from tiny import ROOT, SLAB, TINY, Project

FOLDER = "results/tiny"
TRUE_EFFECT = "glass_transition"


def described() -> dict[str, Any]:
    """Return the tiny study with an STA in place of its TGA, and a glass transition in truth."""
    study = copy.deepcopy(TINY)
    study["parameters"] |= {
        "dh": {"unit": "kJ/kg", "lower": 300, "upper": 1500},
        "c": {"unit": "J/(kg K)", "lower": 1200, "upper": 3000},
        "b_0": {"unit": "W/kg", "lower": -100, "upper": 100},
    }
    (polymer,) = study["material"]["components"].values()
    polymer["specific_heat_J_kgK"] = "c"
    (reaction,) = study["material"]["reactions"].values()
    reaction |= {"heat_of_reaction_J_kg": "dh", "heat_of_combustion_J_kg": 2.4e7}
    heated = {"start_temperature_K": 340, "end_temperature_K": 750}
    release = {"file": "synthetic", "every": 4, "noise": 2e3}
    study["experiments"] = {
        "sta_20K": {
            "kind": "dsc",
            "heating_rate_K_min": 20,
            "baseline": {"level_W_kg": "b_0"},
            **heated,
            "signals": {
                "mass_fraction": {"file": "synthetic", "every": 4, "noise": 0.002},
                "heat_flow": {"file": "synthetic", "every": 3, "noise": 10.0},
            },
        },
        "mcc_60K": {
            "kind": "mcc",
            "heating_rate_K_min": 60,
            "signals": {"specific_heat_release_rate": release},
            **heated,
        },
        "slab_60": SLAB,
        "slab_80": {**SLAB, "front": {"flux_W_m2": 80000, "h_W_m2K": 8}},
    }
    study["synthetic"]["truth"] |= {"dh": 800, "c": 2100, "b_0": 20}
    study["synthetic"]["effects"] = {TRUE_EFFECT: {"step_J_kgK": 600, "temperature_K": 440}}
    kinetics = study["kinetics"]
    kinetics["estimate"] = ["T_p", "E_p", "dh", "c", "b_0"]
    kinetics["cost"] = [
        {"experiment": "sta_20K", "signal": s, "kind": "RMSE", "normalisation": "mean"}
        for s in ("mass_fraction", "heat_flow")
    ]
    kinetics["compare"] = ["mcc_60K"]
    study["diagnosis"] = {
        "calibrate": {"sta_20K": ["mass_fraction", "heat_flow"], "slab_60": ["mlr"]},
        "estimate": ["T_p", "E_p", "dh", "c", "b_0", "rho", "k"],
        "effects": ["glass_transition", "k_T", "tga_lag"],
        "most_effects": 1,
    }
    return study


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """Return a project in which the study was run and diagnosed."""
    project = Project.copy(ROOT, tmp_path_factory.mktemp("calorimetry") / "project")
    project.write(described())
    run = project.snakemake("--cores", "2", "all", "diagnose")
    assert run.code == 0, run.said
    return project


def test_report_shows_heat_flow_and_heat_release(finished: Project) -> None:
    page = finished.read(f"{FOLDER}/report.html").decode("utf-8")
    for words in ("Heat flow and heat release of heated samples", "specific heat release rate"):
        assert words in page
    scores = finished.read(f"{FOLDER}/tables/heat_scores.csv").decode("utf-8").splitlines()
    assert len(scores) == 3
    assert scores[1].startswith("RMSE of heat flow,")
    assert ",yes," in scores[1]
    assert ",no," in scores[2]


def test_effect_on_the_specific_heat_is_found_by_the_heat_flow(finished: Project) -> None:
    found = json.loads(finished.read(f"{FOLDER}/diagnosis/diagnosis.json"))
    assert found["verdict"]["effects"] == [TRUE_EFFECT]
    windows = {(w["experiment"], w["signal"]) for w in found["windows"]}
    assert ("sta_20K", "heat_flow") in windows
    assert (finished.root / FOLDER / "diagnosis" / "heat_flow.svg").is_file()
