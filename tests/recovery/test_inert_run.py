"""A run on an inert plate determines what acts on the sample, and so narrows what it is fitted."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from pyrofit.config import Study, as_study
from pyrofit.estimate.identify import Identification, identify
from pyrofit.estimate.likelihood import likelihood_of
from pyrofit.estimate.problem import make_problem
from pyrofit.experiments.slab.kind import course
from pyrofit.model.accuracy import Accuracy
from pyrofit.simulate import simulate_gasification
from pyrofit.solver.curves import Request
from pyrofit.stages.measurements import computed

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
COPPER = {
    "density_kg_m3": 8940,
    "conductivity_W_mK": 390,
    "specific_heat_J_kgK": 385,
    "emissivity": 0.95,
}
TRUTH = {"k": 0.2, "eps": 0.9, "h": 9.0, "q": 26.0, "k_board": 0.1}


def twin(*costs: str) -> Study:
    """A sample on a board, and a copper plate on the same board, under one flux and one h."""
    given: dict[str, Any] = json.loads(json.dumps(yaml.safe_load(SMOKE.read_text())))
    slab = given["experiments"]["slab_25"]
    slab["front"] |= {"flux_W_m2": "q", "h_W_m2K": "h"}
    slab["duration_s"] = 900
    del slab["sample"]["foil"]
    slab["sample"]["backing"] = [{"component": "board", "thickness_m": 0.012}]
    plate = json.loads(json.dumps(slab))
    plate["sample"]["layers"] = [{"thickness_m": 0.003, "composition": {"copper": 1.0}}]
    plate["signals"] = {"back_temperature": {"file": "synthetic", "every": 10, "noise": 0.5}}
    slab["signals"] = {"mlr": {"file": "synthetic", "every": 5, "average_s": 5, "noise": 2e-4}}
    given["experiments"] = {"sample": slab, "plate": plate}
    given["material"]["components"] |= {
        "copper": COPPER,
        "board": {"density_kg_m3": 700, "conductivity_W_mK": "k_board", "specific_heat_J_kgK": 900},
    }
    values = {"T_p": 605, "E_p": 190, "rho": 1190, "cp": 2.1, "dh": 800}
    for name, value in values.items():
        given["parameters"][name]["value"] = value
    given["parameters"] |= {
        "h": {"unit": "W/(m2 K)", "lower": 2, "upper": 25},
        "q": {"unit": "kW/m2", "lower": 20, "upper": 32},
        "k_board": {"unit": "W/(m K)", "lower": 0.03, "upper": 0.3},
    }
    given["synthetic"] = {"truth": TRUTH, "accuracy": {"elements": 100}}
    signals = {"sample": "mlr", "plate": "back_temperature"}
    terms = [{"experiment": n, "signal": signals[n], "kind": "RMSE"} for n in costs]
    given["imp"] = {"estimate": list(TRUTH), "kinetics": "described", "costs": {"RMSE": terms}}
    given["validation"] = {"experiments": ["sample"]}
    for key in ("kinetics", "diagnosis", "steps", "published"):
        given.pop(key, None)
    return as_study(given, "twin.yaml")


def identified(study: Study) -> Identification:
    problem = make_problem(
        study,
        study.imp.estimate,
        study.imp.channels,
        computed(study),
        study.material,
        study.fixed_values(),
    )
    truth = np.array([study.true_values()[name] for name in study.imp.estimate])
    likelihood = likelihood_of(problem)
    return identify(likelihood, [likelihood.scaled(truth)])


def test_inert_run_narrows_h_flux_and_board_in_the_joint_fit() -> None:
    alone = {e.name: e for e in identified(twin("sample")).estimates}
    joint = {e.name: e for e in identified(twin("sample", "plate")).estimates}
    # Measured, over the search range: h 0.063 and 0.013, q 0.016 and 0.010, k_board 0.049 and
    # 0.0006, k of the sample 0.015 and 0.009.
    for name, share in {"h": 0.35, "q": 0.8, "k_board": 0.05, "k": 0.8, "eps": 1.0}.items():
        assert joint[name].sd < share * alone[name].sd, name
    for name, estimate in joint.items():
        p = twin("sample").parameters[name]
        assert p.lower is not None
        assert p.upper is not None
        true = (TRUTH[name] - p.lower) / (p.upper - p.lower)
        assert abs(estimate.x - true) < 4.0 * estimate.sd, name


def test_inert_run_is_simulated_to_its_end_and_is_heated_up_throughout() -> None:
    study = twin("plate")
    plate, values = study.experiments["plate"], study.true_values()
    at = Request(np.arange(5.0, 900.0, 5.0))
    names = ("back_temperature", "front_temperature", "mlr", "mass")
    requests = dict.fromkeys(names, at)
    curves = simulate_gasification(plate, study.material, values, requests).signals
    assert np.all(np.diff(curves["back_temperature"]) > 0.0)
    assert not curves["mlr"].any()
    assert curves["mass"] == pytest.approx(0.003 * 8940, rel=1e-12)
    phases = course(plate, study.material, values, at, Accuracy())
    assert not phases.phase.any()
