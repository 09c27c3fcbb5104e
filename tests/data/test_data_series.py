import hashlib
import os
from pathlib import Path
from typing import Any

import pytest

from pyrofit.data.series import Measurement, read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError
from pyrofit.quantities import known_quantities

MLR = """Time,MLR_mean,Temp_avg_all4,MLR_error,Temperature_Error
[s],[kg/s/m^2],[K],[kg/s/m^2],[K]
1,-0.001,0,0.0005,0
3,0.004,0,0.0006,0
5,0.012,0,0.0007,0
"""
BACK = """Time,MLR_mean,Temp_avg_all4,MLR_error,Temperature_Error
[s],[kg/s/m^2],[K],[kg/s/m^2],[K]
0,0,300,0,1
1,0,310,0,2
2,0,330,0,3
"""
TGA = """Time,Temperature,Mass
[s],[K],[mg]
0,310,8
10,320,6
20,330,0
"""
FRACTION = """Time,Temperature,Mass fraction,Error
[s],[K],[g/g],[g/g]
0,310,0.999,0.01
10,320,0.5,0.02
20,330,-0.001,0.01
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "run.csv"
    path.write_text(text, encoding="utf-8")
    return path


def read(folder: Path, quantity: str, text: str, **options: Any) -> Measurement:
    return read_series(SeriesSpec(quantity, write(folder, text), **options))


def with_units(text: str, units: str) -> str:
    """Replace the units row."""
    lines = text.splitlines()
    return "\n".join([lines[0], units, *lines[2:]])


def test_rate_file_gives_time_rate_and_uncertainty(tmp_path: Path) -> None:
    series = read(tmp_path, "mlr", MLR, uncertainty_meaning="two standard deviations")
    assert list(series.frame.columns) == ["time_s", "mlr_kg_m2_s", "mlr_uncertainty_kg_m2_s"]
    assert series.frame["mlr_kg_m2_s"].tolist() == [-0.001, 0.004, 0.012]
    assert series.frame["mlr_uncertainty_kg_m2_s"].tolist() == [0.0005, 0.0006, 0.0007]
    assert series.uncertainty_meaning == "two standard deviations"
    assert series.sha256 == hashlib.sha256(MLR.encode()).hexdigest()
    assert series.source == tmp_path / "run.csv"


def test_notes_tell_dropped_columns_and_negative_values(tmp_path: Path) -> None:
    assert read(tmp_path, "mlr", MLR).notes == (
        "left out, zero throughout: Temp_avg_all4, Temperature_Error",
        "1 of 3 values are negative",
    )


CONE = """Time,Mass,HRR,Back
[s],[g],[kW/m2],[K]
0,70,1.5,
1,69,,
2,68,200,
3,67,,
4,66,2.5,
"""


def test_rows_without_a_value_are_left_out_with_a_note(tmp_path: Path) -> None:
    series = read(tmp_path, "heat_release_rate", CONE)
    assert series.frame["time_s"].tolist() == [0.0, 2.0, 4.0]
    assert series.frame["heat_release_rate_W_m2"].tolist() == [1500.0, 200e3, 2500.0]
    assert "left out, without a value: 2 of 5 rows" in series.notes


def test_line_of_a_wrong_value_counts_the_rows_left_out(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"line 5, column 'HRR': given -800; a heat release rate"):
        read(tmp_path, "heat_release_rate", CONE.replace("200", "-800"))


def test_empty_cell_of_the_time_is_refused(tmp_path: Path) -> None:
    with pytest.raises(
        DataError, match="line 5, column 'Time': given an empty cell or NaN; every row"
    ):
        read(tmp_path, "heat_release_rate", CONE.replace("2,68", ",68"))


@pytest.mark.parametrize(("unit", "factor"), [("kW m-2", 1e3), ("W/m^2", 1.0), ("kW", 1e4)])
def test_heat_release_rate_is_per_area(tmp_path: Path, unit: str, factor: float) -> None:
    text = CONE.replace("[kW/m2]", f"[{unit}]")
    series = read(tmp_path, "heat_release_rate", text, sample_area_m2=0.1)
    assert series.frame["heat_release_rate_W_m2"].tolist() == pytest.approx(
        [1.5 * factor, 200 * factor, 2.5 * factor]
    )


def test_heat_release_rate_in_kW_needs_the_area(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="that of a heat rate; give `sample_area_m2`"):
        read(tmp_path, "heat_release_rate", CONE.replace("[kW/m2]", "[kW]"))


def test_temperature_file_gives_time_temperature_and_uncertainty(tmp_path: Path) -> None:
    frame = read(tmp_path, "back_temperature", BACK).frame
    assert list(frame.columns) == ["time_s", "back_temperature_K", "back_temperature_uncertainty_K"]
    assert frame.to_numpy().tolist() == [[0, 300, 1], [1, 310, 2], [2, 330, 3]]


def test_mass_is_divided_by_its_first_value(tmp_path: Path) -> None:
    series = read(tmp_path, "mass_fraction", TGA)
    assert list(series.frame.columns) == ["time_s", "temperature_K", "mass_fraction"]
    assert series.frame["mass_fraction"].tolist() == [1.0, 0.75, 0.0]
    assert series.notes == ("mass divided by its first value, 8e-06 kg", "no uncertainty is known")


def test_mass_is_divided_by_the_given_mass(tmp_path: Path) -> None:
    series = read(tmp_path, "mass_fraction", TGA, sample_mass_kg=10e-6)
    assert series.frame["mass_fraction"].tolist() == pytest.approx([0.8, 0.6, 0.0], rel=1e-14)
    assert series.notes[0] == "mass divided by the mass of the sample, 1e-05 kg"


def test_uncertainty_of_a_mass_is_divided_like_the_mass(tmp_path: Path) -> None:
    text = TGA.replace("Mass\n", "Mass,Mass error\n").replace("[mg]", "[mg],[g]")
    rows = "".join(f"{line},0.0004\n" for line in text.splitlines()[2:])
    frame = read(tmp_path, "mass_fraction", "\n".join(text.splitlines()[:2]) + "\n" + rows).frame
    assert frame["mass_fraction_uncertainty"].tolist() == pytest.approx([0.05] * 3, rel=1e-14)


def test_mass_fraction_is_taken_as_it_is(tmp_path: Path) -> None:
    frame = read(tmp_path, "mass_fraction", FRACTION, sample_mass_kg=3e-6).frame
    assert frame["mass_fraction"].tolist() == [0.999, 0.5, -0.001]
    assert frame["mass_fraction_uncertainty"].tolist() == [0.01, 0.02, 0.01]


def test_percent_is_a_hundredth(tmp_path: Path) -> None:
    text = "Time (s),Temperature (K),Mass fraction (%)\n0,300,100\n1,310,50\n2,320,25\n"
    frame = read(tmp_path, "mass_fraction", text).frame
    assert frame["mass_fraction"].tolist() == pytest.approx([1.0, 0.5, 0.25], rel=1e-14)


@pytest.mark.parametrize(("unit", "factor"), [("s", 1.0), ("min", 60.0), ("h", 3600.0)])
def test_time_is_converted(tmp_path: Path, unit: str, factor: float) -> None:
    frame = read(tmp_path, "mlr", MLR, units={"time": unit}).frame
    assert frame["time_s"].tolist() == [factor, 3 * factor, 5 * factor]


FLUXES = {
    "kg/s/m^2": 1.0,
    "kg/m2/s": 1.0,
    "kg/(m2 s)": 1.0,
    "kg/(s·m²)": 1.0,
    "kg m-2 s-1": 1.0,
    "KG s^-1 m^-2": 1.0,
    "g/m2/s": 1e-3,
    "g/s/m^2": 1e-3,
    "[mg/m2s]": 1e-6,
}


@pytest.mark.parametrize(("unit", "factor"), FLUXES.items())
def test_every_spelling_of_a_flux_is_converted(tmp_path: Path, unit: str, factor: float) -> None:
    frame = read(tmp_path, "mlr", MLR, units={"value": unit, "uncertainty": unit}).frame
    assert frame["mlr_kg_m2_s"].tolist()[2] == pytest.approx(0.012 * factor, rel=1e-14)
    assert frame["mlr_uncertainty_kg_m2_s"][0] == pytest.approx(0.0005 * factor, rel=1e-14)


@pytest.mark.parametrize(("unit", "factor"), [("kg/s", 1.0), ("g/s", 1e-3), ("mg/s", 1e-6)])
def test_mass_rate_is_divided_by_the_area(tmp_path: Path, unit: str, factor: float) -> None:
    units = {"value": unit, "uncertainty": unit}
    frame = read(tmp_path, "mlr", MLR, units=units, sample_area_m2=0.02).frame
    assert frame["mlr_kg_m2_s"][2] == pytest.approx(0.6 * factor, rel=1e-14)
    assert frame["mlr_uncertainty_kg_m2_s"][0] == pytest.approx(0.025 * factor, rel=1e-14)


def test_uncertainty_of_a_flux_is_not_divided_by_the_area(tmp_path: Path) -> None:
    frame = read(tmp_path, "mlr", MLR, units={"value": "kg/s"}, sample_area_m2=0.02).frame
    assert frame["mlr_uncertainty_kg_m2_s"][0] == 0.0005


def test_mass_rate_without_area_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="give `sample_area_m2`"):
        read(tmp_path, "mlr", MLR, units={"value": "g/s"})


@pytest.mark.parametrize("unit", ["degC", "°C", "C", "deg C", "[°c]"])
def test_celsius_shifts_temperatures_but_not_their_uncertainty(tmp_path: Path, unit: str) -> None:
    units = {"value": unit, "uncertainty": unit}
    frame = read(tmp_path, "back_temperature", BACK, units=units).frame
    assert frame["back_temperature_K"].tolist() == pytest.approx([573.15, 583.15, 603.15])
    assert frame["back_temperature_uncertainty_K"].tolist() == [1.0, 2.0, 3.0]


def test_number_fills_the_uncertainty_column(tmp_path: Path) -> None:
    series = read(tmp_path, "mlr", MLR, uncertainty=0.002)
    assert series.frame["mlr_uncertainty_kg_m2_s"].tolist() == [0.002] * 3
    assert "one uncertainty is given for all points" in series.notes


def test_uncertainty_that_is_zero_throughout_counts_as_none(tmp_path: Path) -> None:
    text = "Time (s),MLR (g/m2/s),Error (g/m2/s)\n0,1,0\n1,2,0\n2,3,0\n"
    for columns in ({}, {"uncertainty": "Error"}):
        series = read(tmp_path, "mlr", text, columns=columns)
        assert list(series.frame.columns) == ["time_s", "mlr_kg_m2_s"]
        assert series.notes == ("no uncertainty is known", "left out, zero throughout: Error")


@pytest.mark.parametrize("header", ["MLR_mean", "mlr mean", "Mass Loss Rate", "MASS-LOSS-RATE"])
def test_headers_are_recognised_in_any_spelling(tmp_path: Path, header: str) -> None:
    text = f"TIME (s),{header} (g/m2/s)\n0,1\n1,2\n2,3\n"
    assert read(tmp_path, "mlr", text).frame["mlr_kg_m2_s"][0] == 0.001


@pytest.mark.parametrize("asked", ["q", "Q", "q (g/m2/s)"])
def test_column_is_read_under_the_name_asked_for(tmp_path: Path, asked: str) -> None:
    text = "Time (s),MLR (g/m2/s),q (g/m2/s)\n0,1,4\n1,2,5\n2,3,6\n"
    frame = read(tmp_path, "mlr", text, columns={"value": asked}).frame
    assert frame["mlr_kg_m2_s"].tolist() == [0.004, 0.005, 0.006]


def test_spelling_decides_between_headers_that_differ_in_case(tmp_path: Path) -> None:
    text = "Time (s),t (g/m2/s),T (g/m2/s)\n0,1,4\n1,2,5\n2,3,6\n"
    frame = read(tmp_path, "mlr", text, columns={"value": "T"}).frame
    assert frame["mlr_kg_m2_s"][0] == 0.004


def changed(old: str, new: str, text: str = MLR) -> str:
    assert old in text
    return text.replace(old, new)


REFUSED: dict[str, tuple[str, str, dict[str, Any], str]] = {
    "unknown value": ("mlr", changed("MLR_mean", "MLRmeans"), {}, "Did you mean 'MLRmeans'"),
    "unknown time": ("mlr", changed("Time", "tempo"), {}, r"known to be the time.*Known: .*tempo"),
    "only placeholders": (
        "mlr",
        BACK,
        {},
        "Known: Temp_avg_all4, Temperature_Error, Time. Zero throughout: MLR_mean, MLR_error",
    ),
    "no temperature": (
        "mass_fraction",
        changed("Temperature", "Furnace", TGA),
        {},
        r"the temperature of mass_fraction.*`columns: \{temperature: ...\}`",
    ),
    "ambiguous": (
        "mass_fraction",
        changed("Error", "Mass", FRACTION),
        {},
        r"\['Mass fraction', 'Mass'\] may all be the value",
    ),
    "asked but absent": ("mlr", MLR, {"columns": {"value": "MLRmeen"}}, "Did you mean 'MLR_mean'"),
    "asked but zero": (
        "mlr",
        MLR,
        {"columns": {"value": "Temp_avg_all4"}},
        "column 'Temp_avg_all4': zero throughout",
    ),
    "asked twice": ("mlr", MLR, {"columns": {"value": "Time", "time": "Time"}}, "two roles"),
    "unknown unit": (
        "mlr",
        changed("[s]", "[fortnight]"),
        {},
        r"column 'Time': unknown unit 'fortnight' of the time. Known: h, min, s.*units: \{time",
    ),
    "unit of another quantity": ("mlr", MLR, {"units": {"value": "K"}}, "unknown unit 'K'"),
    "no unit": ("mlr", with_units(MLR, "[s],,[K]"), {}, r"'MLR_mean': no unit of the value; Known"),
    "unit without column": (
        "mass_fraction",
        TGA,
        {"units": {"uncertainty": "g/g"}},
        "no column is read for it",
    ),
    "two points": ("mlr", MLR[: MLR.index("5,0.012")], {}, "given 2 points.*at least 3"),
    "time stands": (
        "mlr",
        changed("\n5,", "\n3,"),
        {},
        "line 5, column 'Time': given 3; time must",
    ),
    "time falls": ("mlr", changed("\n3,", "\n0.5,"), {}, "line 4, column 'Time': given 0.5"),
    "time below zero": ("mlr", changed("\n1,", "\n-1,"), {}, "line 3, column 'Time': given -1"),
    "negative uncertainty": (
        "mlr",
        changed("0.0006", "-0.0006"),
        {},
        "line 4, column 'MLR_error': given -0.0006; an uncertainty is never negative",
    ),
    "sign": (
        "mlr",
        changed("0.004", "-0.004").replace("0.012", "-0.012"),
        {},
        "line 5, column 'MLR_mean': given -0.012; a mass loss rate is positive",
    ),
    "grams as kilograms": ("mlr", changed("0.012", "12"), {}, "line 5.*given 12.*unit is wrong"),
    "Celsius as kelvins": (
        "back_temperature",
        changed("0,0,300", "0,0,25", BACK),
        {},
        "line 3, column 'Temp_avg_all4': given 25; back_temperature_K is then 25.*degC",
    ),
    "Celsius as kelvins in TGA": (
        "mass_fraction",
        changed("310", "40", TGA),
        {},
        r"line 3, column 'Temperature': given 40.*units: \{temperature",
    ),
    "below absolute zero": (
        "back_temperature",
        changed("0,0,300", "0,0,-1", BACK),
        {},
        "given -1; back_temperature_K is then -1",
    ),
    "too hot": ("back_temperature", changed("330", "3300", BACK), {}, "line 5.*given 3300"),
    "percent as fraction": (
        "mass_fraction",
        changed("0.999", "99.9", FRACTION),
        {},
        "given 99.9; mass_fraction is then 99.9",
    ),
    "fraction as percent": (
        "mass_fraction",
        FRACTION,
        {"units": {"value": "%"}},
        "mass_fraction is then 0.00999",
    ),
    "mass of the sample in mg": (
        "mass_fraction",
        TGA,
        {"sample_mass_kg": 8.0},
        "mass_fraction is then 1e-06.*check the mass",
    ),
    "first mass zero": ("mass_fraction", changed(",8\n", ",0\n", TGA), {}, "first mass is 0 kg"),
}


@pytest.mark.parametrize(
    ("quantity", "text", "options", "message"), REFUSED.values(), ids=REFUSED.keys()
)
def test_broken_series_is_refused_with_its_place(
    tmp_path: Path, quantity: str, text: str, options: dict[str, Any], message: str
) -> None:
    with pytest.raises(DataError, match=message) as error:
        read(tmp_path, quantity, text, **options)
    assert str(tmp_path / "run.csv") in str(error.value)


BAD_SPECS: dict[str, tuple[str, dict[str, Any], str]] = {
    "quantity": ("mlrr", {}, "unknown quantity 'mlrr'. Did you mean 'mlr'"),
    "role of columns": ("mlr", {"columns": {"tim": "Time"}}, "`columns` .* Did you mean 'time'"),
    "role of units": ("mlr", {"units": {"temperature": "K"}}, "`units` .*unknown role"),
    "two uncertainties": (
        "mlr",
        {"uncertainty": 1.0, "columns": {"uncertainty": "x"}},
        "both a number and a column",
    ),
} | {
    f"{key} {number}": ("mlr", {key: number}, f"{key} = {number}; it must be a number above 0")
    for key in ("uncertainty", "sample_mass_kg", "sample_area_m2")
    for number in (0.0, -1.0, float("nan"), float("inf"))
}


@pytest.mark.parametrize(("quantity", "options", "message"), BAD_SPECS.values(), ids=BAD_SPECS)
def test_impossible_description_is_refused(
    quantity: str, options: dict[str, Any], message: str
) -> None:
    with pytest.raises(DataError, match=message):
        SeriesSpec(quantity, Path("run.csv"), **options)


@pytest.mark.measured
def test_every_file_of_two_laboratories_is_read_without_options() -> None:
    from pyrofit.data.fetch import locate, registry

    lengths = {}
    for name in registry():
        if name.endswith(".csv") and "PMMA/" in name and ("UMD" in name or "UMET" in name):
            quantity = "mass_fraction" if "_TGA_" in name else "back_temperature"
            quantity = "mlr" if name.endswith("_Mass.csv") else quantity
            series = read_series(SeriesSpec(quantity, locate(name)))
            lengths[series.source.name] = len(series.frame)
            assert (known_quantities()[quantity].uncertainty_column in series.frame) == (
                "UMET" not in name
            )
    assert lengths["UMD_CAPA_25kW_Temp.csv"] == 1805
    assert lengths["UMET_TGA_N2_1K_1.csv"] == 922
    assert len(lengths) == 12


FLAWED = {
    # Its unit is that of a heat rate: it needs the area.
    "Edinburgh_Cone_65kW_6.csv",
}


@pytest.mark.measured
def test_heat_release_of_every_laboratory_is_read_without_naming_columns() -> None:
    # 139 of the 140 files of 17 laboratories that have a heat release rate, pine wood and PMMA.
    root = Path(os.environ["PYROFIT_DATA_DIR"])
    found = sorted(root.glob("*/Calibration_Data/*/*_Cone_*.[cC][sS][vV]"))
    read_in = set()
    for path in found:
        if path.name in FLAWED or "INSTITUTE-X" in path.name:
            continue
        heat = read_series(SeriesSpec("heat_release_rate", path)).frame["heat_release_rate_W_m2"]
        assert 2e4 < heat.max() < 3e6, path
        read_in.add(path.parent.name)
    if not found:
        pytest.skip("the data base has no files of cone calorimeters")
    assert len(found) >= 140
    assert len(read_in) >= 17
