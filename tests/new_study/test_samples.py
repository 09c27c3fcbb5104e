"""Mass and area of a sample stand once for all files of an experiment; init asks once."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from pyrofit.config import as_study, read_study
from pyrofit.config.expand.samples import with_samples
from pyrofit.new_study.marks import marked_lines
from pyrofit.new_study.write import init
from pyrofit.stages.reading import check_measurements

SECONDS = np.arange(0.0, 900.0, 5.0)
SLAB = 70.0 / (1.0 + np.exp((SECONDS - 300.0) / 30.0))
RATE = np.gradient(-SLAB, SECONDS) * 2400.0
KELVIN = np.linspace(300.0, 900.0, 201)
TIME = 6.0 * (KELVIN - 300.0)
LOST = 8.5 / (1.0 + np.exp((640.0 - KELVIN) / 12.0))


def table(path: Path, header: str, *columns: np.ndarray) -> Path:
    np.savetxt(path, np.c_[columns], "%.6g", ",", header=header, comments="")
    return path


def with_repeats(tests: Any) -> dict[str, Any]:
    shared = {"sample_mass_kg": 1e-5, "signals": {"mass_fraction": {"file": "a.csv"}}}
    return {"experiments": {"a": {**shared, "repeats": {"tests": tests}}}}


@pytest.mark.parametrize("listed", [False, True])
def test_repeats_take_the_mass_of_the_experiment_or_their_own(listed: bool) -> None:
    tests = [{"signals": {}}, {"sample_mass_kg": 2e-5, "signals": {}}]
    given = with_samples(with_repeats(tests if listed else dict(zip("bc", tests, strict=True))))
    found = given["experiments"]["a"]["repeats"]["tests"]
    masses = [test["sample_mass_kg"] for test in (found if listed else found.values())]
    assert masses == [1e-5, 2e-5]
    assert "sample_mass_kg" not in given["experiments"]["a"]


def test_computed_signals_and_own_values_stay() -> None:
    own = {"file": "a.csv", "sample_area_m2": 0.02}
    signals = {"mlr": {"file": "synthetic"}, "mass": own, "back_temperature": "synthetic"}
    given = {"experiments": {"a": {"sample_area_m2": 0.01, "signals": signals}}}
    assert with_samples(given)["experiments"]["a"]["signals"] == signals


def test_tared_records_of_an_experiment_start_at_its_mass(tmp_path: Path) -> None:
    header = "Time (s),Temperature (K),TG (mg)"
    files = [table(tmp_path / f"b_10K_{i}.csv", header, TIME, KELVIN, -LOST) for i in (1, 2)]
    study, _ = init("x", {"tga": files}, tmp_path)
    given = yaml.safe_load(study.read_text("utf-8"))
    (name,) = given["experiments"]
    given["experiments"][name]["sample_mass_kg"] = 1e-5
    found = check_measurements(as_study(given, str(study)), str(study))
    assert len(found) == 2
    for frame, _ in found.values():
        np.testing.assert_allclose(frame["mass_fraction"], 1.0 - LOST / 10.0, atol=1e-5)


def test_values_that_slabs_share_are_asked_once(tmp_path: Path) -> None:
    header = "Time (s),Mass (g),HRR (kW/m2)"
    files = [
        table(tmp_path / f"board_{q}kW_{i}.csv", header, SECONDS, SLAB * (1 + 0.01 * i), RATE)
        for q in (25, 50, 75)
        for i in (1, 2)
    ]
    study, _ = init("x", {"cone": files}, tmp_path)
    text = study.read_text("utf-8")
    experiments = text[text.index("\nexperiments:") :]
    for words in ("thickness_m: 0.006}] # CHANGE", "<<: &front # CHANGE", "&flame 20000 # CHANGE"):
        assert experiments.count(words) == 1
    assert experiments.count("sample_area_m2: &area 0.01 # CHANGE") == 1
    assert len(marked_lines(experiments)) == 6 + 2 * 3  # flux and ignition of each test
    found = read_study(study).experiments
    assert {e.front.h_W_m2K for e in found.values()} == {10}  # type: ignore[union-attr]
    areas = {s.sample_area_m2 for e in found.values() for s in e.signals.values()}
    assert areas == {0.01}


def test_init_prints_one_line_for_files_of_the_same_columns(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    header = "Time (s),Mass (g),HRR (kW/m2),T back 1 (K),T back 2 (K),O2 (%)"
    files = []
    for q in (25, 50):
        own = 1.0 + 1e-4 * q
        columns = SLAB / own, RATE * own, SECONDS * own + 300.0, SECONDS * own + 301.0
        path = tmp_path / f"board_{q}kW.csv"
        files.append(table(path, header, SECONDS, *columns, 0.0 * SECONDS + 20.9))
    _, lines = init("x", {"cone": files}, tmp_path)
    start = f"{files[0]}, {files[1].name}: "
    (line,) = [line for line in lines if "time 'Time'" in line]
    assert line.startswith(start)
    assert line.count("time 'Time'") == 1
    for column in ("Mass", "HRR", "T back 1", "T back 2", "O2"):
        assert f"'{column}'" in line
    assert "CHANGE" not in capsys.readouterr().out
