"""A test of a real laboratory: PMMA on an aluminium block on ceramic paper, Edinburgh's cone."""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from pyrofit.config import Study, as_study
from pyrofit.experiments import kind_of
from pyrofit.stages.reading import read_all

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
FILE = "PMMA/Calibration_Data/Edinburgh/Edinburgh_Cone_25kW_1.csv"
pytestmark = pytest.mark.measured
BLOCK = {
    "density_kg_m3": 2700,
    "conductivity_W_mK": 200,
    "specific_heat_J_kgK": 950,
    "emissivity": 0.3,
}
PAPER = {"density_kg_m3": 200, "conductivity_W_mK": 0.06, "specific_heat_J_kgK": 1100}


def edinburgh(*backing: tuple[str, float]) -> Study:
    """6 mm PMMA of the smoke study's truth under 25 kW/m2, lit at 103 s; a thermocouple behind."""
    given: dict[str, Any] = json.loads(json.dumps(yaml.safe_load(SMOKE.read_text())))
    for name, value in given["synthetic"]["truth"].items():
        given["parameters"][name]["value"] = value
    given["material"]["components"] |= {"aluminium": BLOCK, "paper": PAPER}
    around = {"gas_temperature_K": 290, "wall_temperature_K": 290}
    file = str(Path(os.environ["PYROFIT_DATA_DIR"]).resolve() / FILE)
    signal = {"file": file, "columns": {"value": "Back Temp"}, "until_s": 1100}
    given["experiments"] = {
        "cone": {
            "kind": "cone",
            "sample": {
                "layers": [{"thickness_m": 0.006}],
                "backing": [{"component": n, "thickness_m": d} for n, d in backing],
                "initial_temperature_K": 287,
            },
            "front": {"flux_W_m2": 25000, "h_W_m2K": 10, **around},
            "back": {"h_W_m2K": 3, "emissivity": 0.9, **around},
            "flame": {"flux_W_m2": 10000, "ignition_s": 103},
            "signals": {"in_depth_temperature": {"depth_m": 0.011, **signal}},
        }
    }
    term = {"experiment": "cone", "signal": "in_depth_temperature", "kind": "RMSE"}
    given["imp"] = {"estimate": ["k"], "kinetics": "described", "costs": {"RMSE": [term]}}
    given["validation"] = {"experiments": ["cone"]}
    for key in ("kinetics", "diagnosis", "robustness", "published", "synthetic"):
        given.pop(key, None)
    return as_study(given, "edinburgh.yaml")


def off(study: Study) -> float:
    """Root mean square [K] of simulated less measured temperature."""
    experiment = study.experiments["cone"]
    frame = read_all(study)["cone", "in_depth_temperature"][0]
    kind, time = kind_of(experiment), frame["time_s"].to_numpy(float)
    request = kind.request(experiment, "in_depth_temperature", frame, time)
    asked = [{"in_depth_temperature": request}]
    values = study.fixed_values()
    (curves,) = kind.simulate([experiment], study.material, values, asked, study.accuracy)[0]
    column = experiment.quantity("in_depth_temperature").column
    found = curves.signals["in_depth_temperature"] - frame[column].to_numpy(float)
    return float(np.sqrt(np.mean(found**2)))


def test_block_behind_the_sample_explains_the_thermocouple_in_it() -> None:
    # Values of books, nothing fitted; the block heats up by 250 K. Measured: 44 K and 119 K.
    block = off(edinburgh(("aluminium", 0.010), ("paper", 0.003)))
    paper = off(edinburgh(("paper", 0.013)))
    assert block < 50.0
    assert paper > 2.0 * block
