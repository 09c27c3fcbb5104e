"""Experiments without a measurement are predicted."""

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pyrofit.config import Study, as_study, read_mapping
from pyrofit.config.check.unmeasured import unmeasured
from pyrofit.errors import StudyError
from pyrofit.experiments import kind_of
from pyrofit.solver.curves import Request
from pyrofit.stages.unmeasured import POINTS, predict_unmeasured

ROOT = Path(__file__).parents[3]


def keys(**changes: Any) -> dict[str, Any]:
    """Return the smoke study with a slab at another flux that nobody measured."""
    given = copy.deepcopy(read_mapping(ROOT / "config" / "smoke.yaml"))
    like = next(e for e in given["experiments"].values() if e["kind"] == "gasification")
    slab = {k: v for k, v in like.items() if k not in ("signals", "title")}
    slab["front"] = {**slab["front"], "flux_W_m2": 40000}
    given["experiments"]["slab_40"] = {**slab, "duration_s": 600, **changes}
    return given


def study(**changes: Any) -> Study:
    return as_study(keys(**changes), "mine.yaml")


def test_experiment_without_signals_is_predicted_as_it_is_simulated() -> None:
    described = study(predicts=["mlr", "back_temperature"])
    assert unmeasured(described) == {"slab_40": ("mlr", "back_temperature")}
    material, values = described.material, described.true_values()
    (density,) = (n for n in described.imp.estimate if described.parameters[n].unit == "kg/m3")
    two = {**values, density: values[density] * np.array([1.0, 1.1])}
    frame = predict_unmeasured(described, material, two, {"one": None, "other": None})
    assert frame.groupby(["experiment", "signal", "set"]).size().tolist() == [POINTS] * 4
    one = frame[(frame["signal"] == "mlr") & (frame["set"] == "one")]
    time, bin_s = one["time_s"].to_numpy(), 600 / POINTS
    np.testing.assert_allclose(np.diff(time), bin_s)
    slab = described.experiments["slab_40"]
    asked = {"mlr": Request(time, bin_s), "back_temperature": Request(time)}
    accuracy = described.accuracy
    (curves,) = kind_of(slab).simulate([slab], material, values, [asked], accuracy)[0]
    np.testing.assert_array_equal(one["simulated"], curves.signals["mlr"])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, "experiments.slab_40.signals: empty; name a measured quantity"),
        (
            {"predicts": ["mrl"]},
            "predicts: unknown quantity 'mrl'. Did you mean 'mlr'?",
        ),
        ({"predicts": ["in_depth_temperature"]}, "unknown quantity 'in_depth_temperature'"),
    ],
)
def test_what_cannot_be_predicted_is_refused(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(StudyError, match="slab_40") as error:
        study(**changes)
    assert said in str(error.value)


def test_prediction_without_a_measurement_has_no_place_in_the_validation() -> None:
    given = keys(predicts=["mlr"])
    given["validation"]["experiments"].append("slab_40")
    with pytest.raises(StudyError, match="'slab_40' has no measured signals to compare; take it"):
        as_study(given, "mine.yaml")
