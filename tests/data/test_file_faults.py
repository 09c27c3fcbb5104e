"""Faults of measured files: refused or noted with the place and the way out."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pyrofit.data.series import Measurement, read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.data.suspect import suspicions
from pyrofit.errors import DataError
from pyrofit_files.report import examine_folder

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


def heated(path: Path, mass: np.ndarray) -> Path:
    """Write a record of a heated sample."""
    T = np.linspace(300.0, 900.0, mass.size)
    rows = [f"{6.0 * (x - 300.0):.7g},{x:.7g},{m:.7g}" for x, m in zip(T, mass, strict=True)]
    text = "\n".join(["Time (s),Temperature (K),Mass (mg)", *rows])
    path.write_text(text, encoding="utf-8")
    return path


CHANGES = {
    "mass": ("Mass change", "mg", [0.010, 0.0, -2.0, -4.59], "the initial mass in mg"),
    "more than all": ("Mass change", "%", [0.0, -0.5, -40.0, -192.0], "the initial mass in %"),
}


@pytest.mark.parametrize(("name", "unit", "values", "whole"), CHANGES.values(), ids=CHANGES)
def test_change_of_mass_is_refused_with_the_way_out(
    name: str, unit: str, values: list[float], whole: str, tmp_path: Path
) -> None:
    rows = [f"{10 * i},{310 + 10 * i},{value}" for i, value in enumerate(values)]
    text = "\n".join([f"Time (s),Temperature (K),{name} ({unit})", *rows])
    words = rf"line 5, column '{name}': .* near 0, .* falls: .* a change of mass. Add {whole} to"
    with pytest.raises(DataError, match=words):
        read(tmp_path, "mass_fraction", text, columns={"value": name})
    with pytest.raises(DataError):  # of a mass below the loss
        read(tmp_path, "mass_fraction", text, columns={"value": name}, sample_mass_kg=1e-6)


def test_change_of_mass_from_a_given_mass_is_read(tmp_path: Path) -> None:
    rows = [f"{10 * i},{310 + 10 * i},{m}" for i, m in enumerate([0.0, -0.5, -2.0, -4.5])]
    text = "\n".join(["Time (s),Temperature (K),Mass (mg)", *rows])
    found = read(tmp_path, "mass_fraction", text, sample_mass_kg=5e-6).frame["mass_fraction"]
    np.testing.assert_allclose(found, [1.0, 0.9, 0.6, 0.1], atol=1e-12)


@pytest.mark.parametrize(("name", "unit", "whole"), [("TG", "%", 100.0), ("Mass change", "1", 1.0)])
def test_change_of_mass_as_a_fraction_is_read(
    name: str, unit: str, whole: float, tmp_path: Path
) -> None:
    rows = [f"{10 * i},{310 + 10 * i},{whole * m}" for i, m in enumerate([0.0, -0.1, -0.5, -0.92])]
    text = "\n".join([f"Time (s),Temperature (K),{name} ({unit})", *rows])
    found = read(tmp_path, "mass_fraction", text, columns={"value": name})
    np.testing.assert_allclose(found.frame["mass_fraction"], [1.0, 0.9, 0.5, 0.08], atol=1e-12)
    assert "a change of mass: 100 % is added" in found.notes


TIMES = {
    "rounded": ([0, 0, 0, 60, 60, 60], "4 rows are so: the times are rounded"),
    "second test": ([0, 10, 20, 30, 0, 10], "start anew, as of a second test or segment"),
    "reversed": ([50, 40, 30, 20, 10, 0], "The rows stand in reverse order"),
    "one row": ([0, 10, 20, 15, 30, 40], "Sort the rows"),
}


@pytest.mark.parametrize(("times", "words"), TIMES.values(), ids=TIMES)
def test_times_that_do_not_rise_are_refused_with_the_way_out(
    times: list[int], words: str, tmp_path: Path
) -> None:
    rows = [f"{t},{310 + 10 * i},{5 - 0.1 * i}" for i, t in enumerate(times)]
    text = "\n".join(["Time (s),Temperature (K),Mass (mg)", *rows])
    with pytest.raises(DataError, match=f"time must exceed that of the row before. .*{words}"):
        read(tmp_path, "mass_fraction", text)


def test_few_rows_before_time_0_are_left_out_with_a_note(tmp_path: Path) -> None:
    rows = [f"{t},{5 - 0.001 * t}" for t in (-0.4, *range(100))]
    text = "\n".join(["Time (s),Mass (kg/m2)", *rows])
    found = read(tmp_path, "mass", text)
    assert found.frame["time_s"].iloc[0] == 0.0
    assert "left out, before time 0: 1 rows" in found.notes
    with pytest.raises(DataError, match="given -50; time starts at 0 or later"):
        read(tmp_path, "mass", text.replace("-0.4,", "-50,"))


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


def test_file_of_one_column_has_no_further_one_to_name(tmp_path: Path) -> None:
    text = "Time (s),\n0,\n1,\n2,\n"
    with pytest.raises(DataError, match=r"value of mlr; .* The file has no further column\.$"):
        read(tmp_path, "mlr", text, columns={"time": "Time"})


@pytest.mark.parametrize("unit", ["ºC", "℃", "Cel", "°C", "\ufffdC"])
def test_every_sign_of_degrees_celsius_is_known(unit: str, tmp_path: Path) -> None:
    text = TGA.replace("[K]", f"[{unit}]")
    assert read(tmp_path, "mass_fraction", text).frame["temperature_K"].iloc[0] == 310.0 + 273.15


@pytest.mark.parametrize(
    ("times", "masses", "said"),
    [
        ("after {:02d} s", "{}", "line 2, column 'Time': given 'after 00 s'"),
        ("{}", "4,9{:02d}", "line 2, column 'Mass': given '4,900'; it may be 4.900"),
    ],
)
def test_used_column_of_text_alone_is_a_fault_of_its_file(
    times: str, masses: str, said: str, tmp_path: Path
) -> None:
    rows = [f"{times.format(i)};{300 + i};{masses.format(i)}" for i in range(20)]
    text = "\n".join(["Time (s);Temperature (K);Mass (mg)", *rows])
    (tmp_path / "A_TGA_N2_10K_1.csv").write_text(text, encoding="utf-8")
    heated(tmp_path / "A_TGA_N2_10K_2.csv", np.linspace(5.0, 1.0, 60))
    files = {seen.path.stem: seen for seen in examine_folder(tmp_path)}
    assert files["A_TGA_N2_10K_2"].classified
    (fault,) = (f for f in files["A_TGA_N2_10K_1"].findings if f.check == "unreadable")
    assert fault.text.startswith(said)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("start", [0.0, -0.01])
def test_mass_that_begins_at_zero_is_a_fault_and_no_warning(start: float, tmp_path: Path) -> None:
    heated(tmp_path / "A_TGA_N2_10K_1.csv", np.linspace(start, -4.0, 60))
    (seen,) = examine_folder(tmp_path)
    assert ("mass level", "fault") in {(f.check, f.weight) for f in seen.findings}


def test_text_file_without_a_table_is_no_measured_file(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("Samples of May\nsee the README\n", encoding="utf-8")
    with pytest.raises(DataError, match=r"no table in text files such as notes.txt"):
        examine_folder(tmp_path)


def test_reason_why_a_file_is_unreadable_begins_without_a_comma(tmp_path: Path) -> None:
    path = tmp_path / "A_TGA_N2_10K_1.csv"
    path.write_text("0,1\n1,2\n", encoding="utf-8")
    (fault,) = (f for seen in examine_folder(tmp_path) for f in seen.findings)
    assert fault.text.startswith("line 1: the first row holds numbers")


def test_blank_before_a_quote_belongs_to_no_name(tmp_path: Path) -> None:
    rows = "".join(f"{t}, {0.001 * t}\n" for t in range(9))
    found = read(tmp_path, "mlr", f's, kg/m2/s\n"Time", "MLR"\n{rows}')
    assert found.frame["mlr_kg_m2_s"].max() == pytest.approx(0.008)


@pytest.mark.parametrize("between", ["", "\n"])
def test_two_rows_of_facts_are_no_table(between: str, tmp_path: Path) -> None:
    rows = "".join(f"{6 * t};{300 + t};{1.0 - 0.001 * t}\n" for t in range(400))
    facts = f"Sample mass (mg);Rate (K/min)\n5;10\n{between}"
    text = f"{facts}Time (s);Temperature (K);Mass fraction (-)\n{rows}"
    assert len(read(tmp_path, "mass_fraction", text).frame) == 400


def test_line_that_is_too_long_is_told_with_its_beginning(tmp_path: Path) -> None:
    rows = "".join(f"{t},{0.001 * t}\n" for t in range(9))
    with pytest.raises(DataError, match=r"of 200,?002 characters that begins with '1111.*delete"):
        read(tmp_path, "mlr", f"Time (s),MLR (kg/m2/s)\n{rows}{'1' * 200_000},1\n")


def test_record_in_K_that_starts_warm_is_not_taken_for_degrees_C(tmp_path: Path) -> None:
    rows = "".join(f"{6 * t},{573.15 + 0.1 * t},{1.0 - 0.001 * t}\n" for t in range(400))
    for unit, told in (("K", False), ("degC", True)):
        text = f"Time (s),Temperature ({unit}),Mass fraction (-)\n{rows}"
        found = read(tmp_path, "mass_fraction", text)
        assert found.in_K is not told
        said = suspicions(found.quantity, found.frame.assign(temperature_K=573.15), found.in_K)
        assert any("If the column is in K" in note for note in said) is told
