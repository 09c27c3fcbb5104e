"""Records with lost rows, without a loss, with holds or an endless line are told or used right."""

from pathlib import Path

import numpy as np
import pytest

import pyrofit as pf
from pyrofit.data.csvfile import read_table
from pyrofit.data.suspect import suspicions
from pyrofit.errors import DataError
from pyrofit.new_study import draft
from pyrofit.new_study.draft import kinetics_limits
from pyrofit.new_study.plan import part_of
from pyrofit.new_study.repeats import grouped_by_names

R = 8.314462618
RATES = 5.0, 10.0, 20.0
RAMP_K = np.linspace(450.0, 800.0, 226)


def left(time: np.ndarray, kelvin: np.ndarray) -> np.ndarray:
    """Return the mass fraction of one reaction: 1e13 1/s, 180 kJ/mol, residue 0.15."""
    rate = 1e13 * np.exp(-180e3 / (R * kelvin))
    done = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time))])
    return 0.15 + 0.85 * np.exp(-done)


def write(path: Path, *columns: np.ndarray) -> Path:
    header = "Time (s),Temperature (K),Mass fraction (-)"
    np.savetxt(path, np.column_stack(columns), "%.6f", ",", header=header, comments="")
    return path


def ramp(folder: Path, rate: float, lost: slice = slice(0), mass: float | None = None) -> Path:
    """Write a record at a heating rate with noise, without some of its rows."""
    time = (RAMP_K - RAMP_K[0]) / rate * 60.0
    noise = 5e-4 * np.random.default_rng(int(rate)).standard_normal(RAMP_K.size)
    values = left(time, RAMP_K) if mass is None else np.full(RAMP_K.size, mass)
    kept = np.delete(np.arange(RAMP_K.size), np.arange(RAMP_K.size)[lost])
    columns = (time[kept], RAMP_K[kept], (values + (noise if mass is None else 0.0))[kept])
    return write(folder / f"board_N2_{rate:g}K.csv", *columns)


def hold(path: Path, kelvin: float, drift_K: float) -> Path:
    """Write a record of a heating at 10 K/min and a hold that drifts."""
    time = np.linspace(0.0, 9000.0, 451)
    reached = (kelvin - 450.0) * 6.0
    course = (
        np.minimum(450.0 + time / 6.0, kelvin) + drift_K * np.clip(time - reached, 0, None) / 9e3
    )
    return write(path, time, course, left(time, course))


@pytest.mark.solver
def test_fit_bridges_lost_rows(tmp_path: Path) -> None:
    files = [ramp(tmp_path, rate, slice(95, 115)) for rate in RATES[:2]]
    with pytest.warns(UserWarning, match="no point of the mass fraction lies between"):
        fit = pf.fit(pf.new_study("board", tga=files), profiles=False)
    assert fit.values["E_p"] == pytest.approx(180.0, rel=0.02)
    assert fit.values["y"] == pytest.approx(0.15, abs=0.003)


def test_fit_of_a_constant_mass_is_refused(tmp_path: Path) -> None:
    study = pf.new_study("board", tga=[ramp(tmp_path, 10.0, mass=1.0)])
    with (
        pytest.warns(UserWarning, match="so it shows no reaction"),
        pytest.raises(DataError, match="all 226 values are equal"),
    ):
        pf.fit(study, profiles=False)


@pytest.mark.solver
def test_simulation_at_data_reads_no_file_again(tmp_path: Path) -> None:
    path = ramp(tmp_path, 10.0)
    study = pf.new_study("board", tga=[path])
    data = pf.read_data(study)
    path.unlink()
    values = {"T_p": 587.7, "E_p": 180.0, "y": 0.15}
    found = pf.simulate(study, values, data=data).series["board_N2_10K", "mass_fraction"]
    np.testing.assert_allclose(found["mass_fraction"], left(found["time_s"], RAMP_K), atol=2e-3)


def test_a_line_of_megabytes_is_told_with_its_file(tmp_path: Path) -> None:
    path = ramp(tmp_path, 10.0)
    path.write_text(path.read_text() + "1" * 5_000_000 + "\n", encoding="utf-8")
    with pytest.raises(DataError, match=r"board_N2_10K.csv"):
        read_table(path)


def test_repeats_of_a_hold_are_one_program_of_four(tmp_path: Path) -> None:
    runs = [draft.read_experiment("tga", ramp(tmp_path, rate)) for rate in RATES]
    for n in (1, 2, 3):
        path = hold(tmp_path / f"board_563Kiso_R{n}.csv", 563.0, 0.4)
        runs.append(draft.read_experiment("tga", path))
    assert [run.number for run in runs[3:]] == pytest.approx([10.0] * 3, rel=0.03)
    tests = grouped_by_names(runs)
    assert len(tests) == 4
    assert len(part_of("kinetics", tests).held_out) == 1


def test_a_ramp_beside_a_hold_of_its_rate_holds_nothing(tmp_path: Path) -> None:
    files = [ramp(tmp_path, 10.0), hold(tmp_path / "board_563Kiso.csv", 563.0, 0.4)]
    study = pf.new_study("board", tga=files)
    points = {name: e.set_point_K for name, e in study.experiments.items()}
    assert points == {"board_N2_10K": None, "board_563Kiso": pytest.approx(563.0, abs=0.5)}


def test_residue_is_that_of_ramps_and_of_holds_that_are_level(tmp_path: Path) -> None:
    slow = hold(tmp_path / "board_540Kiso.csv", 540.0, 0.0)  # 0.7 of the mass is left
    level = hold(tmp_path / "board_620Kiso.csv", 620.0, 0.0)
    for files in ([slow, level], [slow, ramp(tmp_path, 10.0)]):
        limits = pf.new_study("board", tga=files).parameters["y"]
        assert (limits.lower, limits.upper) == pytest.approx((0.1, 0.2), abs=0.003)
    assert kinetics_limits([draft.read_experiment("tga", slow)]).known_residue is False


@pytest.mark.parametrize("last_K", [580.0, 600.0])
def test_residue_of_records_that_end_while_the_mass_falls_is_below_their_ends(
    tmp_path: Path, last_K: float
) -> None:
    cut = slice(int(np.searchsorted(RAMP_K, last_K)), None)
    files = [ramp(tmp_path, rate, cut) for rate in RATES]
    ends = [np.loadtxt(file, delimiter=",", skiprows=1)[-5:, 2].mean() for file in files]
    y = pf.new_study("board", tga=files).parameters["y"]
    assert y.lower == 0.0
    assert y.upper == pytest.approx(min(ends) + 0.02, abs=0.003)


@pytest.mark.solver
def test_fit_of_records_that_end_while_the_mass_falls_holds_the_truth(tmp_path: Path) -> None:
    cut = slice(int(np.searchsorted(RAMP_K, 605.0)), None)
    fit = pf.fit(pf.new_study("board", tga=[ramp(tmp_path, rate, cut) for rate in RATES]))
    for name, truth in (("E_p", 180.0), ("y", 0.15)):
        low, high = fit.intervals().loc[name, ["low", "high"]]
        assert low < truth < high


@pytest.mark.parametrize("kind", ["mcc", "dsc"])
def test_residue_that_no_record_tells_is_told_as_assumed(tmp_path: Path, kind: str) -> None:
    time = (RAMP_K - RAMP_K[0]) * 6.0
    rate = -np.gradient(left(time, RAMP_K), time)
    header = {"mcc": "Time (s),Temperature (K),HRR (W/g)", "dsc": "Time (s),T (K),Heat flow (W/g)"}
    path = tmp_path / "foam_N2_10K.csv"
    table = np.column_stack([time, RAMP_K, 2e4 * rate])
    np.savetxt(path, table, "%.6f", ",", header=header[kind], comments="")
    with pytest.warns(UserWarning, match=r"no record of a mass .* residue of 0\.1 kg/kg"):
        pf.new_study("foam", **{kind: [path]})


def test_a_digitised_curve_of_few_rows_starts_at_its_first_value(tmp_path: Path) -> None:
    few = np.linspace(450.0, 800.0, 14)
    values = np.interp(few, RAMP_K, left((RAMP_K - RAMP_K[0]) * 6.0, RAMP_K))
    path = tmp_path / "foam_N2_10K.csv"
    header = "Temperature (K),Mass (%)"
    np.savetxt(
        path, np.column_stack([few, 100.0 * values]), "%.3f", ",", header=header, comments=""
    )
    record = draft.read_experiment("tga", path)
    assert record.signals[0].dried_to is None
    frame = record.frames["mass_fraction"]
    assert not any("starts at" in said for said in suspicions(record.signals[0].of, frame))


@pytest.mark.solver
def test_fit_warns_its_caller_of_a_suspect_record(tmp_path: Path) -> None:
    files = [ramp(tmp_path, rate) for rate in RATES[:2]]
    rows = np.loadtxt(files[0], delimiter=",", skiprows=1)
    rows[:, 2] += 0.01 * np.minimum(np.arange(len(rows)) / 40.0, 1.0)
    write(files[0], *rows.T)
    study = pf.new_study("board", tga=files)
    with pytest.warns(UserWarning, match="rises by 0.8 % before it falls, as buoyancy") as told:
        pf.fit(study, starts=1, profiles=False)
    assert Path(told[0].filename) == Path(__file__)
