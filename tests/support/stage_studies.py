"""Studies and results of the tests of stages."""

import json
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from pyrofit.config import Study, as_study, digest
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results import dependencies
from pyrofit.results.files import Results, write_csv, write_json

CONFIG = Path(__file__).parents[2] / "config"


SMOKE = json.dumps(yaml.safe_load((CONFIG / "smoke.yaml").read_text(encoding="utf-8")))


SMALL = {"complexes": 1, "generations": 3}


def given(**changes: Any) -> dict[str, Any]:
    """Return the smoke study, coarse and with a tiny budget; ``a__b=1`` sets a.b to 1."""
    study: dict[str, Any] = json.loads(SMOKE)
    study["accuracy"] = {"cells": 10}
    for name in ("slab_25", "slab_60"):
        study["experiments"][name]["duration_s"] = 300
    study["synthetic"]["accuracy"] = {"elements": 40, "tolerance": 1e-4}
    for stage in ("kinetics", "imp"):
        study[stage] |= {"sceua": dict(SMALL), "least_squares": {"starts": 1}}
    for place, value in changes.items():
        *above, last = place.split("__")
        part: Any = study
        for key in above:
            part = part[key]
        part[last] = value
    return study


def study_with(**changes: Any) -> Study:
    return as_study(given(**changes), "smoke.yaml")


SETS = {
    "RMSE": [0.3, 0.2],
    "RANGE": [0.1, 0.1],
    "BANDS": [0.5, 0.6],
}
"""Costs of the repetitions made by hand."""


def parameters(cost: str, repetition: int) -> dict[str, float]:
    density = 1150.0 + 10.0 * repetition + list(SETS).index(cost)
    return {"rho": density, "k": 0.2, "cp": 2100.0, "eps": 0.9, "dh": 800e3}


def by_hand(study: Study, results: Results) -> None:
    for cost, found in SETS.items():
        for repetition, value in enumerate(found):
            write_json(
                results.repetition(cost, repetition, ".json"),
                {
                    "cost_function": cost,
                    "repetition": repetition,
                    "seed": 1,
                    "digest": digest(dependencies.imp(study, cost, "sceua")),
                    "cost": value,
                    "cost_refined": value,
                    "parameters": parameters(cost, repetition),
                    "calls": 22,
                    "failed_calls": 0,
                    "generations": 2,
                },
            )
            frame = {"generation": [1, 2], "calls": [11, 22], "best_cost": [1.0, value]}
            write_csv(results.repetition(cost, repetition, "_convergence.csv"), pd.DataFrame(frame))
        start = {"cost": 0.05, "calls": 9, "at_bound": [], "parameters": parameters(cost, 5)}
        write_json(
            results.starts(cost, "least_squares"),
            {"cost_function": cost, "seed": 1, "starts": [start, {**start, "cost": 0.07}]},
        )
        end = {**start, "cost": 0.06, "parameters": parameters(cost, 7)}
        write_json(
            results.starts(cost, "cmaes"), {"cost_function": cost, "seed": 1, "starts": [end]}
        )


def searched_by_hand(study: Study, results: Results, values: dict[str, float]) -> None:
    """Write searches that all end at a set, SI units by name."""
    own = {name: values[name] for name in study.imp.estimate}
    end = {"cost": 1.0, "calls": 9, "at_bound": [], "parameters": own}
    best = {"cost": 1.0, "cost_refined": 1.0, "calls": 22, "failed_calls": 0, **own}
    for cost in study.imp.costs:
        for optimiser in OPTIMISERS:
            starts = {"cost_function": cost, "seed": 1, "starts": [end]}
            write_json(results.starts(cost, optimiser), starts)
    rows = [{"cost_function": cost, "repetition": 0, **best} for cost in study.imp.costs]
    write_csv(results.imp("summary.csv"), pd.DataFrame(rows))


def estimated_by_hand(results: Results, values: dict[str, float], stage: str = "imp") -> None:
    """Write estimates as the step identify does, without its analysis."""
    numbers = (
        "sd",
        "apparatus_sd",
        "low",
        "high",
        "width",
        "noise_low",
        "noise_high",
        "noise_width",
    )
    words = ("apparatus_most", "bound", "low_open", "high_open", "method", "verdict")
    row = {**dict.fromkeys(numbers, 0.1), **dict.fromkeys(words, "")}
    rows = [{"parameter": name, "estimate": value, **row} for name, value in values.items()]
    write_csv(results.identification("estimate.csv", stage), pd.DataFrame(rows))
