"""A number in the name of a file is a hint: what the record shows comes first."""

from pathlib import Path

import numpy as np
import pytest

from pyrofit.experiments import files_of
from pyrofit.new_study import draft
from pyrofit.new_study.plan import part_of
from pyrofit.new_study.words import number_comment, other_number
from pyrofit.new_study.write import drafted

KELVIN = np.linspace(300.0, 900.0, 121)
MASS = 1.0 - 0.9 / (1.0 + np.exp((640.0 - KELVIN) / 12.0))


def ramp(path: Path, K_min: float, times: bool = True, in_one_s: float = 1.0) -> Path:
    """Write a record at a heating rate."""
    columns = {"Time (s)": 60.0 * (KELVIN - 300.0) / K_min / in_one_s} if times else {}
    columns |= {"Temperature (K)": KELVIN, "Mass (%)": 100.0 * MASS}
    header = ",".join(columns)
    np.savetxt(path, np.transpose([*columns.values()]), "%.5f", ",", header=header, comments="")
    return path


@pytest.mark.parametrize(
    ("name", "number", "words"),
    [
        ("NH4Cl", 10.0, "CHANGE: neither the file nor its name tells it"),
        ("HDPE_batch3", 10.0, "CHANGE: neither the file nor its name tells it"),
        ("sample_12", 12.0, "CHANGE: a number in the name of the file"),
        ("PA66_N2", 10.0, "CHANGE: neither"),
        ("board_563K", 10.0, "CHANGE: neither"),
        ("board_2p5K", 2.5, "CHANGE where wrong: from the name of the file alone"),
        ("board_2,5K", 2.5, "CHANGE where wrong: from the name of the file alone"),
        ("foam_beta20", 20.0, "CHANGE where wrong: from the name of the file alone"),
        ("foam_heating_rate_5", 5.0, "CHANGE where wrong: from the name of the file alone"),
        ("alphabeta20", 10.0, "CHANGE: neither"),
        ("board_20K", 20.0, "CHANGE where wrong: from the name of the file alone"),
    ],
)
def test_name_of_a_record_without_times_is_no_more_than_a_hint(
    name: str, number: float, words: str, tmp_path: Path
) -> None:
    run = draft.read_experiment("tga", ramp(tmp_path / f"{name}.csv", 10.0, times=False))
    assert run.number == number
    assert number_comment(run).startswith(words)
    assert f"heating_rate_K_min: {number:g} # CHANGE" in drafted("x", {"tga": [run.path]})[0]


@pytest.mark.parametrize("name", ["test7", "plate_6mm", "Testdata-127", "cone_25kW"])
def test_flux_of_a_name_is_marked(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{name}.csv"
    t = np.arange(0.0, 300.0, 5.0)
    np.savetxt(path, np.c_[t, 5.0 + 0 * t], "%g", ",", header="Time (s),MLR (g/s/m2)", comments="")
    run = draft.read_experiment("gasification", path)
    assert "CHANGE" in number_comment(run)
    if name in ("test7", "plate_6mm"):
        assert run.number == 50.0


@pytest.mark.parametrize("name", ["plate_35kWm2_run2", "plate_35kWm-2", "35kW_m2", "35 kW m^2"])
def test_flux_of_a_name_may_have_its_area(name: str, tmp_path: Path) -> None:
    assert files_of("cone").number.find(name) == (35.0, "unit")


def test_flux_of_a_name_may_stand_behind_its_symbol() -> None:
    find = files_of("gasification").number.find
    assert find("LAB_Wood_GASIFICATION_q30_6mm") == (30.0, "unit")
    assert find("seq30")[1] == ""


@pytest.mark.parametrize("heated_s", [0.0, 1500.0])
@pytest.mark.parametrize("name", ["foam_300C_hold", "foam_300", "foam_573K"])
def test_temperature_of_a_hold_in_a_name_is_no_heating_rate(
    name: str, heated_s: float, tmp_path: Path
) -> None:
    t = np.linspace(0.0, 6000.0, 301)
    kelvin = 573.15 - 0.2 * np.clip(heated_s - t, 0.0, None)
    path = tmp_path / f"{name}.csv"
    columns, header = np.c_[t, kelvin, np.exp(-t / 3000.0)], "Time (s),Temp (K),Mass (1)"
    np.savetxt(path, columns, "%.5f", ",", header=header, comments="")
    run = draft.read_experiment("tga", path)
    assert run.number == (12.0 if heated_s else 10.0)
    assert not other_number(run)
    assert number_comment(run) == (
        "" if heated_s else "CHANGE: neither the file nor its name tells it"
    )


@pytest.mark.parametrize("name", ["board_10K", "board_10"])
@pytest.mark.parametrize(
    ("in_one_s", "way"),
    [(60.0, "{time: min}"), (3600.0, "{time: h}"), (1 / 60.0, "{time: s}"), (1e-3, "by 1000")],
)
def test_times_in_another_unit_than_the_header_says_are_told(
    name: str, in_one_s: float, way: str, tmp_path: Path
) -> None:
    run = draft.read_experiment("tga", ramp(tmp_path / f"{name}.csv", 10.0, in_one_s=in_one_s))
    assert run.number == pytest.approx(10.0 * in_one_s, rel=0.01)
    (said,) = other_number(run)
    assert "its name says 10 K/min" in said
    assert way in said
    assert f"# CHANGE: {said}" in drafted("x", {"tga": [run.path]})[0]


def test_other_rate_than_the_name_says_is_told(tmp_path: Path) -> None:
    assert other_number(draft.read_experiment("tga", ramp(tmp_path / "a_10K.csv", 10.4))) == []
    # A number alone is no rate by itself.
    assert other_number(draft.read_experiment("tga", ramp(tmp_path / "a_12.csv", 20.0))) == []
    (said,) = other_number(draft.read_experiment("tga", ramp(tmp_path / "a_10K_R2.csv", 20.0)))
    assert said == "the record shows a heating rate of 20 K/min, its name says 10 K/min"


@pytest.mark.parametrize("ramped", [True, False])
def test_drift_of_a_hold_is_no_heating_rate(ramped: bool, tmp_path: Path) -> None:
    t = np.arange(0.0, 9000.0, 20.0)
    T = np.where(t < 1560.0, 303.0 + t / 6.0, 563.0) if ramped else 563.0 + 0 * t
    T = T + 0.4 * t / t[-1]
    path = tmp_path / "board_563Kiso.csv"
    header = "Time (s),Temperature (K),Mass (mg)"
    np.savetxt(path, np.c_[t, T, 5.0 - t / 4e3], "%.4f", ",", header=header, comments="")
    hold = draft.read_experiment("tga", path)
    assert (hold.number, hold.told) == (10.0, "record" if ramped else "")
    ramps = [
        draft.read_experiment("tga", ramp(tmp_path / f"b_{n:g}K.csv", n)) for n in (5.0, 10.0, 20.0)
    ]
    assert part_of("kinetics", [hold, *ramps]).held_out == ("b_10K",)
