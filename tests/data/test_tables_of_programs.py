"""Tables as FDS, Gpyro and instruments write them, with their odd rows."""

from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from pyrofit.data.csvfile import read_table
from pyrofit.data.series import read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError
from pyrofit.new_study import draft

KELVIN = np.linspace(300.0, 900.0, 61)
TIME = 6.0 * (KELVIN - 300.0)
MASS = 1.0 - 0.9 / (1.0 + np.exp((640.0 - KELVIN) / 12.0))


def written(path: Path, above: str, *columns: np.ndarray | list[str]) -> Path:
    rows = ("".join(f"{c}," for c in row).rstrip(",") for row in zip(*columns, strict=True))
    path.write_text(above + "\n".join(rows) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("quote", ["", '"'])
def test_units_of_fds_stand_above_the_names(quote: str, tmp_path: Path) -> None:
    names = ",".join(f"{quote}{name}{quote}" for name in ("Time", "Temp", "Mass", "MLR"))
    above = f"s,C,g/g,1/s\n{names}\n"
    path = written(tmp_path / "a_tga.csv", above, TIME, KELVIN - 273.15, MASS, 0.001 * MASS)
    frame = draft.read_experiment("tga", path).frames["mass_fraction"]
    np.testing.assert_allclose(frame, np.c_[TIME, KELVIN, MASS], atol=1e-9)


def test_devices_and_heat_release_of_fds_are_read(tmp_path: Path) -> None:
    above = 's,kg/m2/s,C,kg/m2\n"Time","MLR","TEMP BACK","MASS"\n'
    path = written(tmp_path / "a_devc.csv", above, TIME, 0.001 * MASS, KELVIN - 273.15, 6.0 * MASS)
    frames = draft.read_experiment("gasification", path).frames
    np.testing.assert_allclose(frames["mlr"]["mlr_kg_m2_s"], 0.001 * MASS)
    np.testing.assert_allclose(frames["back_temperature"]["back_temperature_K"], KELVIN)
    np.testing.assert_allclose(frames["mass"]["mass_kg_m2"], 6.0 * MASS)
    path = written(tmp_path / "a_hrr.csv", "s,kW,kW\nTime,HRR,Q_RADI\n", TIME, MASS, -0.3 * MASS)
    frames = draft.read_experiment("cone", path).frames
    np.testing.assert_allclose(frames["heat_release_rate"].iloc[:, 1], 1e3 * MASS / 0.01)


def test_symbols_of_one_letter_above_numbers_stay_names(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", "s,K,m\ns,K,mg\n", TIME, KELVIN, MASS)
    assert list(read_table(path).units.values()) == ["s", "K", "mg"]


def test_count_above_rows_without_names_is_that_of_gpyro(tmp_path: Path) -> None:
    path = written(tmp_path / "exp_01_01.csv", f" {TIME.size} \n", TIME, MASS)
    table = read_table(path)
    assert any("Gpyro" in note for note in table.mended)
    np.testing.assert_allclose(np.transpose([*table.columns.values()]), np.c_[TIME, MASS])
    assert list(table.columns) == ["Time", "column 2"]
    run = draft.read_experiment("tga", table.path)
    (found,) = run.signals
    assert found.columns == {"time": "Time", "value": "column 2"}
    assert (found.guessed, found.missing) == (("value",), ())
    assert (run.lacks, run.told) == ("temperature", "")
    kelvin = 300.0 + TIME / 6.0  # 10 K/min are assumed
    np.testing.assert_allclose(run.frames["mass_fraction"], np.c_[TIME, kelvin, MASS])
    assert not draft.read_experiment("gasification", table.path).signals[0].columns.get("value")
    other = written(tmp_path / "other.csv", f"{TIME.size + 1}\n", TIME, MASS)
    with pytest.raises(DataError, match="a row with their names must stand right above"):
        read_table(other)


def test_unit_behind_a_name_with_a_bracket_is_read(tmp_path: Path) -> None:
    above = "##Temp./°C,Time/min,Mass(subtr.2)/%\n"
    path = written(tmp_path / "a.csv", above, KELVIN - 273.15, TIME / 60.0, 100.0 * MASS)
    run = draft.read_experiment("tga", path)
    assert run.signals[0].guessed == ()
    np.testing.assert_allclose(run.frames["mass_fraction"]["mass_fraction"], MASS)


def test_second_of_two_rows_of_one_time_is_left_out_with_a_note(tmp_path: Path) -> None:
    time = np.insert(TIME, 20, TIME[19])
    kelvin, mass = np.insert(KELVIN, 20, KELVIN[19]), np.insert(MASS, 20, 0.5)
    path = written(tmp_path / "a.csv", "Time (s),Temperature (K),Mass (-)\n", time, kelvin, mass)
    found = read_series(SeriesSpec("mass_fraction", path))
    np.testing.assert_allclose(found.frame["mass_fraction"], MASS)
    note = "left out, the time of the row before: 1 rows, first line 22"
    assert note in found.notes
    assert note in draft.read_experiment("tga", path).mended


@pytest.mark.parametrize("change", ["most", "back"])
def test_times_that_stand_still_or_go_back_are_refused(change: str, tmp_path: Path) -> None:
    time = np.repeat(TIME[::2], 2)[: TIME.size] if change == "most" else TIME.copy()
    time[30] = time[30] if change == "most" else time[20]
    path = written(tmp_path / "a.csv", "Time (s),Temperature (K),Mass (-)\n", time, KELVIN, MASS)
    with pytest.raises(DataError, match="time must exceed that of the row before"):
        read_series(SeriesSpec("mass_fraction", path))


def test_times_of_day_go_on_past_midnight(tmp_path: Path) -> None:
    day = (86_000 + TIME.astype(int)) % 86_400
    clock = [f"{t // 3600:02}:{t // 60 % 60:02}:{t % 60:02}" for t in day]
    path = written(tmp_path / "a.csv", "Time,Temperature (K),Mass (-)\n", clock, KELVIN, MASS)
    table = read_table(path)
    np.testing.assert_allclose(table.columns["Time"], TIME)
    line = 2 + int(np.argmax(TIME >= 400.0))
    assert f"the time of day passes midnight at line {line}" in table.mended[-1]
    assert draft.read_experiment("tga", path).number == pytest.approx(10.0)


@pytest.mark.parametrize(
    "form", ["%Y-%m-%d %H:%M:%S", "%d.%m.%Y %H:%M:%S", "%Y-%m-%dT%H:%M:%S", "%I:%M:%S %p"]
)
@pytest.mark.parametrize("name", ["Time", "Date/Time"])
def test_dates_and_halves_of_a_day_are_read(form: str, name: str, tmp_path: Path) -> None:
    begin = datetime(2024, 2, 28, 11, 40)
    clock = [(begin + timedelta(seconds=float(t) // 1)).strftime(form) for t in TIME]
    path = written(tmp_path / "a.csv", f"{name},Temperature (K),Mass (-)\n", clock, KELVIN, MASS)
    frame = draft.read_experiment("tga", path).frames["mass_fraction"]
    time = frame["time_s"].to_numpy()
    np.testing.assert_allclose(time - time[0], TIME // 1)


def test_a_date_whose_day_is_not_clear_is_no_time(tmp_path: Path) -> None:
    clock = [f"03/04/2024 {int(t) // 3600:02}:{int(t) // 60 % 60:02}:00" for t in TIME]
    path = written(tmp_path / "a.csv", "Date/Time,Temperature (K),Mass (-)\n", clock, KELVIN, MASS)
    assert not draft.read_experiment("tga", path).frames
    with pytest.raises(DataError, match="given '03/04/2024 00:00:00'"):
        read_series(SeriesSpec("mass_fraction", path, {"time": "Date/Time"}))


def test_rate_is_that_of_the_heating_whatever_rounding_and_slow_end_it_has(tmp_path: Path) -> None:
    kelvin = np.arange(383.0, 883.0)
    time = np.rint(np.cumsum(np.where(kelvin < 800.0, 3.0, 30.0)))
    mass = 1.0 - 0.9 / (1.0 + np.exp((640.0 - kelvin) / 12.0))
    path = written(tmp_path / "a.csv", "Time (s),Temperature (K),Mass (-)\n", time, kelvin, mass)
    assert draft.read_experiment("tga", path).number == pytest.approx(20.0)


def test_total_heat_flow_stands_beside_its_parts(tmp_path: Path) -> None:
    parts = ("Reversing", "Non-Reversing", "Total")
    names = ",".join(f"{part} Heat Flow (Normalized) W/g" for part in parts)
    above = f"Time (s),Tp (K),{names}\n"
    path = written(tmp_path / "a.csv", above, TIME, KELVIN, 2.0 * MASS, 3.0 * MASS, 5.0 * MASS)
    frame = draft.read_experiment("dsc", path).frames["heat_flow"]
    np.testing.assert_allclose(frame, np.c_[TIME, KELVIN, 5e3 * MASS])
