"""Tables that hold several tests side by side become a file each."""

from pathlib import Path

import numpy as np
import pytest

from pyrofit.config import read_study
from pyrofit.data.csvfile import read_table
from pyrofit.model.heated import HeatedExperiment
from pyrofit.new_study.wide_tables import split
from pyrofit.new_study.write import init

T = np.linspace(300.0, 800.0, 101)


def mass(rate: float) -> np.ndarray:
    return 100.0 - 90.0 / (1.0 + np.exp(-(T - 600.0 - 8.0 * np.log(rate)) / 12.0))


def written(path: Path, header: str, columns: list[np.ndarray], delimiter: str = ",") -> Path:
    np.savetxt(path, np.column_stack(columns), "%.4f", delimiter, header=header, comments="")
    return path


@pytest.mark.parametrize(
    ("header", "own"),
    [
        ("temperature,rate_3,rate_5,rate_10", False),
        ("T [°C],3 K/min,5 K/min,10 K/min", False),
        ("Temperature (K),m_3 (%),Temperature (K),m_5 (%),Temperature (K),m_10 (%)", True),
    ],
)
def test_rates_as_columns_become_a_test_each(header: str, own: bool, tmp_path: Path) -> None:
    at = T - 273.15 if "°C" in header else T
    masses = [mass(rate) for rate in (3, 5, 10)]
    columns = [c for m in masses for c in (at, m)] if own else [at, *masses]
    table = written(tmp_path / "ALL.csv", header, columns)
    study, lines = init("x", {"tga": [table]}, tmp_path)
    assert "times follow from the rates" in lines[0]
    found = read_study(study).experiments
    rates = [e.heating_rate_K_min for e in found.values() if isinstance(e, HeatedExperiment)]
    assert sorted(rates) == [3, 5, 10]
    read = read_table(study.parent / "data" / "ALL_5K.csv").columns
    assert read["Time"] == pytest.approx((T - T[0]) * 12.0, abs=0.01)
    assert read["Mass"] == pytest.approx(mass(5), abs=1e-3)


@pytest.mark.parametrize(
    "header",
    [
        "time (s),temperature,rate_3,rate_5,rate_10",
        "temperature,mass,signal,other",
        "temperature,run_1 3 K,run_2 5 K,run_3 10 K",
        "temperature,rate_3,again_3,rate_10",
    ],
    ids=["time", "no rates", "two numbers", "one rate twice"],
)
def test_table_that_is_not_clear_stays_one(header: str, tmp_path: Path) -> None:
    columns = [T, T, *(mass(rate) for rate in (3, 5, 10))][-len(header.split(",")) :]
    table = written(tmp_path / "ALL.csv", header, columns)
    assert split("tga", table, tmp_path) == [table]


def test_slabs_are_not_split(tmp_path: Path) -> None:
    table = written(tmp_path / "a.csv", "temperature,rate_3,rate_5", [T, mass(3), mass(5)])
    assert split("gasification", table, tmp_path) == [table]
