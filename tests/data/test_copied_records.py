"""Records that hold the numbers of another file."""

import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import pyrofit as pf
from pyrofit import cli
from pyrofit.data.copies import copies

T = np.arange(400.0, 800.0, 4.0)


def record(path: Path, rate: float, centre: float = 640.0, points: int = 100) -> None:
    mass = 5.0 * (0.05 + 0.95 / (1.0 + np.exp((T - centre) / 12.0)))
    columns = {"time_s": 60.0 / rate * (T - T[0]), "temperature_K": T, "mass_mg": mass}
    pd.DataFrame(columns)[:points].to_csv(path, index=False)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_init_leaves_the_copy_out_whose_name_tells_another_rate(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record(Path("pmma_5K.csv"), 5.0, 630.0)
    record(Path("pmma_10K.csv"), 20.0, points=95)
    record(Path("pmma_20K.csv"), 20.0)
    files = ["pmma_5K.csv", "pmma_10K.csv", "pmma_20K.csv"]
    assert cli.main(["init", "mine", "--tga", *files]) == 0
    said = capsys.readouterr().out
    assert (
        "pmma_20K.csv: the first 95 of 100 values of the mass fraction, with time and temperature, "
        "are those of pmma_10K.csv. pmma_10K is left out; give one of both to choose it"
    ) in said
    study = pf.read_study("mine/mine.yaml")
    assert set(study.experiments) == {"pmma_5K", "pmma_20K"}


def test_check_tells_the_copy_and_its_columns(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record(Path("a_10K.csv"), 10.0)
    record(Path("b_10K.csv"), 10.0, 650.0)
    assert cli.main(["init", "mine", "--tga", "a_10K.csv", "b_10K.csv"]) == 0
    (folder / "mine" / "data" / "b_10K.csv").write_bytes(Path("a_10K.csv").read_bytes())
    capsys.readouterr()
    assert cli.main(["check", "mine/mine.yaml"]) == 0
    assert (
        "look at this record: all 100 values of the mass fraction, with time and temperature, are "
        "those of mine/data/a_10K.csv. Leave one of both out"
    ) in capsys.readouterr().err


def test_python_warns_of_a_copy_and_leaves_it_out() -> None:
    mass = 0.05 + 0.95 / (1.0 + np.exp((T - 640.0) / 12.0))
    table = (6.0 * (T - T[0]), T, mass)
    with pytest.warns(UserWarning, match="second_10K is left out"):
        study = pf.new_study("x", tga={"first_10K": table, "second_10K": table})
    assert set(study.experiments) == {"first_10K"}


def test_records_that_differ_are_no_copies(folder: Path) -> None:
    record(Path("a_10K.csv"), 10.0)
    record(Path("b_10K.csv"), 10.0, 641.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(pf.new_study("x", tga=["a_10K.csv", "b_10K.csv"]).experiments) == 2


def test_values_at_rest_are_no_copy() -> None:
    y = np.concatenate([np.ones(30), np.linspace(1.0, 0.0, 30)])
    z = np.concatenate([np.ones(30), np.linspace(1.0, 0.1, 30)])
    assert not list(copies([("mass", y), ("mass", z)]))
    (found,) = copies([("mass", y), ("mass", z[::-1]), ("mass", y[20:])])
    assert (found.position, found.of, found.same, found.end) == (2, 0, 40, "last")


def test_equal_repeats_are_looked_at(folder: Path) -> None:
    record(Path("a_10K_1.csv"), 10.0)
    record(Path("a_10K_2.csv"), 10.0)
    assert pf.look(folder).looked.tests[0].disagreements == []


def test_one_curve_at_other_times_is_no_copy(folder: Path) -> None:
    record(Path("a_10K.csv"), 10.0)
    record(Path("b_20K.csv"), 20.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(pf.new_study("x", tga=["a_10K.csv", "b_20K.csv"]).experiments) == 2
