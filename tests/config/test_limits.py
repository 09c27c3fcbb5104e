"""BANDS between two columns of the measured file: read, checked, windowed, computed."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pyrofit.config import TermSpec, as_study, read_mapping
from pyrofit.data.series import Measurement, read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError, StudyError
from pyrofit.estimate.targets import term_for
from pyrofit.quantities import known_quantities
from pyrofit.stages.reading import check_terms, read_all
from pyrofit.steps.robustness.compute import with_values

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
NAMES = {"value": "MLR", "lower": "q05", "upper": "q95"}
MLR = """Time,MLR,q05,q95
[s],[g/s/m^2],[g/s/m^2],[kg/s/m^2]
0,2,0,0.003
10,4,3,0.008
20,6,5,0.007
30,6,5,0.007
"""
TERM = {"experiment": "slab_25", "signal": "mlr", "kind": "BANDS", "limits": "columns"}


def read(folder: Path, text: str = MLR, quantity: str = "mlr", **keys: Any) -> Measurement:
    (folder / "run.csv").write_text(text, encoding="utf-8")
    return read_series(SeriesSpec(quantity, folder / "run.csv", **{"columns": NAMES, **keys}))


def given(folder: Path, text: str = MLR, columns: Any = NAMES, **term: Any) -> dict[str, Any]:
    """Return the keys of the smoke study with a measured rate between limits."""
    (folder / "run.csv").write_text(text, encoding="utf-8")
    keys = read_mapping(SMOKE)
    signals = keys["experiments"]["slab_25"]["signals"]
    signals["mlr"] = {"file": (folder / "run.csv").as_posix(), "columns": dict(columns)}
    keys["imp"]["costs"] = {"BANDS": [{**TERM, **term}]}
    return keys


def test_limits_are_read_in_their_own_units(tmp_path: Path) -> None:
    frame = read(tmp_path).frame
    assert frame["mlr_lower_kg_m2_s"].tolist() == [0.0, 0.003, 0.005, 0.005]
    assert frame["mlr_upper_kg_m2_s"].tolist() == [0.003, 0.008, 0.007, 0.007]


def test_limits_of_a_mass_are_divided_by_the_same_mass(tmp_path: Path) -> None:
    text = "Time [s],Temperature [degC],Mass [mg],low [mg],high [mg]\n" + "".join(
        f"{t},{t},{m},{m - 1},{m + 1}\n" for t, m in ((0, 8), (60, 4), (120, 2))
    )
    columns = {"lower": "low", "upper": "high"}
    frame = read(tmp_path, text, "mass_fraction", columns=columns).frame
    assert frame["mass_fraction_lower"].tolist() == [7 / 8, 3 / 8, 1 / 8]
    assert frame["mass_fraction_upper"].tolist() == [9 / 8, 5 / 8, 3 / 8]


def test_limits_of_a_temperature_are_temperatures_not_differences(tmp_path: Path) -> None:
    text = "Time [s],T [degC],low [degC],high [K]\n0,20,19,294.15\n1,30,29,304\n2,40,39,314\n"
    columns = {"value": "T", "lower": "low", "upper": "high"}
    frame = read(tmp_path, text, "back_temperature", columns=columns).frame
    assert frame["back_temperature_lower_K"].tolist() == [292.15, 302.15, 312.15]
    assert frame["back_temperature_upper_K"].tolist() == [294.15, 304.0, 314.0]


def test_limit_that_is_zero_throughout_is_a_limit(tmp_path: Path) -> None:
    text = MLR.replace(",3,0.008", ",0,0.008").replace(",5,0.007", ",0,0.007")
    series = read(tmp_path, text)
    assert not series.frame["mlr_lower_kg_m2_s"].any()
    assert not any("zero throughout" in note for note in series.notes)


@pytest.mark.parametrize(
    ("text", "columns", "words"),
    [
        (
            MLR.replace("10,4,3,0.008", "10,4,9,0.008"),
            NAMES,
            r"line 4, column 'q05': given 9; the lower limit lies above the upper one. Exchange",
        ),
        (MLR, {"lower": "q05"}, "`columns` names the lower limit alone; name both"),
        (MLR, {**NAMES, "upper": "q99"}, "there is no column 'q99' for the upper"),
        (MLR, {**NAMES, "middle": "q05"}, "unknown role 'middle'"),
        (
            MLR.replace("[kg/s/m^2]", "[K]"),
            NAMES,
            "column 'q95': unknown unit 'K' of the upper",
        ),
    ],
)
def test_broken_limits_are_refused(
    tmp_path: Path, text: str, columns: dict[str, str], words: str
) -> None:
    with pytest.raises(DataError, match=words):
        read(tmp_path, text, columns=columns)


def test_cost_is_zero_between_the_limits_and_the_distance_beyond(tmp_path: Path) -> None:
    study = as_study(given(tmp_path), "study.yaml")
    measurements = {key: frame for key, (frame, _) in read_all(study).items()}
    check_terms(study, measurements)
    term = term_for(study, study.imp.costs["BANDS"][0], measurements)
    assert term(np.array([0.003, 0.0031, 0.0069, 0.005])) == 0.0
    # Off by 1, 0, 2 and 0 g/(m2 s): the root mean square is sqrt(5 / 4).
    assert term(np.array([0.004, 0.008, 0.003, 0.006])) == pytest.approx(1.25**0.5 * 1e-3)


def test_limits_are_windowed_and_interpolated_with_the_target(tmp_path: Path) -> None:
    keys = given(tmp_path, window_s=[10, 20], points=3)
    study = as_study(keys, "study.yaml")
    measurements = {key: frame for key, (frame, _) in read_all(study).items()}
    term = term_for(study, study.imp.costs["BANDS"][0], measurements)
    assert term.target.time_s.tolist() == [10.0, 15.0, 20.0]
    # Half way the limits are 4 and 7.5 g/(m2 s).
    assert term.residuals(np.array([0.003, 0.004, 0.005])).tolist() == [0.0, 0.0, 0.0]
    beyond = term.residuals(np.array([0.003, 0.0085, 0.005])) * np.sqrt(3)
    assert beyond == pytest.approx([0.0, 1e-3, 0.0])


@pytest.mark.parametrize(
    ("term", "columns", "words"),
    [
        ({}, {"value": "MLR"}, r"imp\.costs\.BANDS\.0\.limits: name the columns lower and upper"),
        ({"kind": "RMSE"}, NAMES, "RMSE takes no limits; leave `limits` out"),
        ({"options": {"n_sigma": 2}}, NAMES, "give `limits`, or `n_sigma` under options; not both"),
        ({"limits": "lines"}, NAMES, "limits: 'lines' must be 'columns'"),
        ({"signal": "back_temperature"}, NAMES, "is computed, and has no columns; leave `limits`"),
    ],
)
def test_limits_that_cannot_be_are_refused(
    tmp_path: Path, term: dict[str, Any], columns: dict[str, str], words: str
) -> None:
    with pytest.raises(StudyError, match=words):
        as_study(given(tmp_path, columns=columns, **term), "study.yaml")


def test_limits_move_with_the_values_of_a_twin(tmp_path: Path) -> None:
    frame = read(tmp_path).frame
    quantity = known_quantities()["mlr"]
    moved = with_values(frame, quantity, frame["mlr_kg_m2_s"].to_numpy() + 0.01, 2.0)
    # 2 g/(m2 s) is 2 above its lower and 1 below its upper limit: 12 - 4 and 12 + 2.
    assert moved["mlr_lower_kg_m2_s"][0] == pytest.approx(0.008)
    assert moved["mlr_upper_kg_m2_s"][0] == pytest.approx(0.014)


def test_term_without_limits_has_those_of_its_uncertainty() -> None:
    assert TermSpec(experiment="a", signal="b", kind="BANDS").limits is None
