"""Faults of measured files: refused or noted with the place and the way out."""

from pathlib import Path
from typing import Any

import pytest

from pyrofit.data.series import Measurement, read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError

TGA = """Time,Temperature,Mass
[s],[K],[mg]
0,310,8
10,320,6
20,330,0
"""


def read(folder: Path, quantity: str, text: str, **options: Any) -> Measurement:
    path = folder / "run.csv"
    path.write_text(text, encoding="utf-8")
    return read_series(SeriesSpec(quantity, path, **options))


CHANGES = {
    "mass": ("Mass change", "mg", [0.010, 0.0, -2.0, -4.59], "the initial mass in mg"),
    "percent": ("Mass change", "%", [0.0, -0.5, -40.0, -92.0], "100"),
    "fraction": ("Mass", "1", [0.0, -0.1, -0.5, -0.9], "1"),
}


@pytest.mark.parametrize(("name", "unit", "values", "whole"), CHANGES.values(), ids=CHANGES)
@pytest.mark.parametrize("more", [{}, {"sample_mass_kg": 5e-6}])
def test_change_of_mass_is_refused_with_the_way_out(
    name: str, unit: str, values: list[float], whole: str, more: dict[str, float], tmp_path: Path
) -> None:
    rows = [f"{10 * i},{310 + 10 * i},{value}" for i, value in enumerate(values)]
    text = "\n".join([f"Time (s),Temperature (K),{name} ({unit})", *rows])
    words = rf"line 5, column '{name}': .* near 0, .* falls: .* a change of mass. Add {whole} to"
    with pytest.raises(DataError, match=words):
        read(tmp_path, "mass_fraction", text, columns={"value": name}, **more)


def test_mass_far_below_zero_is_refused_and_noise_about_zero_is_not(tmp_path: Path) -> None:
    text = TGA.replace("20,330,0", "20,330,{}")
    with pytest.raises(DataError, match=r"given -12; a mass is not that far below 0"):
        read(tmp_path, "mass_fraction", text.format(-12))
    frame = read(tmp_path, "mass_fraction", text.format(-0.2)).frame
    assert frame["mass_fraction"].iloc[-1] == pytest.approx(-0.025)


def test_unit_of_the_study_that_differs_from_that_of_the_file_is_noted(tmp_path: Path) -> None:
    text = "Time (s),MLR [g/m²·s]\n0,1\n1,2\n2,3\n"
    series = read(tmp_path, "mlr", text, units={"value": "g/m2/min", "time": "s"})
    assert series.frame["mlr_kg_m2_s"].iloc[0] == pytest.approx(1e-3 / 60.0)
    said = "the value is read in g/m2/min, as the study says; the file says g/m²·s"
    assert [note for note in series.notes if "as the study says" in note] == [said]
    same = read(tmp_path, "mlr", text, units={"value": "g/(m2 s)"})
    assert not any("as the study says" in note for note in same.notes)


def test_column_without_values_is_not_called_zero(tmp_path: Path) -> None:
    text = "Time (s),MLR (kg/m2/s),Temp\n0,{0},NaN\n1,{0},NaN\n2,{0},NaN\n"
    assert "left out, without values: Temp" in read(tmp_path, "mlr", text.format(1)).notes
    with pytest.raises(DataError, match=r"value of mlr; .* Without values: MLR, Temp"):
        read(tmp_path, "mlr", text.format("NaN"))
    with pytest.raises(DataError, match="column 'MLR': it holds no values; the value must be"):
        read(tmp_path, "mlr", text.format("NaN"), columns={"value": "MLR"})
