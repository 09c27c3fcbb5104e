"""Notes on series whose start differs from the described one."""

from pathlib import Path

import pandas as pd
import pytest
import yaml

from pyrofit.analysis.agreement import disagreements
from pyrofit.config import Study, as_study

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
SLAB = "slab_60"


def study(initial: object) -> Study:
    """Return the study of tests with another initial temperature of a slab."""
    given = yaml.safe_load(SMOKE.read_text(encoding="utf-8"))
    given["experiments"][SLAB]["sample"]["initial_temperature_K"] = initial
    if isinstance(initial, str):
        given["parameters"][initial] = {"unit": "K", "lower": 280, "upper": 300}
        given["synthetic"]["truth"][initial] = 290
        given["imp"]["estimate"].append(initial)
    return as_study(given, str(SMOKE))


@pytest.mark.parametrize(
    ("initial", "notes"),
    [
        (298.0, []),
        (290.0, ["starts at 300.0 K, initial_temperature_K of the sample is 290.0"]),
        ("T_0", []),
    ],
    ids=["near", "other", "to be estimated"],
)
def test_the_first_temperature_is_compared(initial: object, notes: list[str]) -> None:
    frame = pd.DataFrame({"time_s": [0.0, 1.0], "back_temperature_K": [300.0, 301.0]})
    assert disagreements(study(initial), SLAB, "back_temperature", frame, "a.csv") == notes
