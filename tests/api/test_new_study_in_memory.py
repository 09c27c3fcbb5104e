"""Drafts of studies from tables and arrays."""

import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import pyrofit as pf
from pyrofit.errors import DataError, StudyError

T = np.arange(400.0, 800.0, 2.0)
RATES = {"tga_5K": 5.0, "tga_20K": 20.0}


def arrays() -> dict[str, np.ndarray]:
    mass = {n: 0.05 + 0.95 / (1.0 + np.exp((T - 630.0 - rate) / 12.0)) for n, rate in RATES.items()}
    return {n: np.column_stack([60.0 * (T - T[0]) / RATES[n], T, m]) for n, m in mass.items()}


def as_recorded(name: str, columns: np.ndarray) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "Time (min)": columns[:, 0] / 60.0,
            "Temperature (C)": columns[:, 1] - 273.15,
            "Mass (mg)": 5.0 * columns[:, 2],
        }
    )


def test_tables_make_the_study_that_their_files_make(tmp_path: Path) -> None:
    tables = {name: as_recorded(name, columns) for name, columns in arrays().items()}
    for name, table in tables.items():
        table.to_csv(tmp_path / f"{name}.csv", index=False)
    study = pf.new_study("wood", tga=tables)
    of_files = pf.new_study("wood", tga=[tmp_path / f"{name}.csv" for name in tables])
    own, theirs = (s.model_dump(mode="json") for s in (study, of_files))
    for keys in own, theirs:
        for experiment in keys["experiments"].values():
            experiment["signals"]["mass_fraction"].pop("file")
    assert own == theirs
    data, read = pf.read_data(study, data=tables), pf.read_data(of_files)
    for name in tables:
        assert np.array_equal(data[name], read[name])


def test_arrays_are_in_si_units_and_may_stand_beside_files(tmp_path: Path) -> None:
    columns = arrays()
    path = tmp_path / "tga_20K.csv"
    as_recorded("tga_20K", columns["tga_20K"]).to_csv(path, index=False)
    study = pf.new_study("wood", tga={"tga_5K": tuple(columns["tga_5K"].T), "tga_20K": path})
    rates = {name: e.heating_rate_K_min for name, e in study.experiments.items()}
    assert rates == pytest.approx(RATES)
    data = pf.read_data(study, data={"tga_5K": columns["tga_5K"]})
    assert np.allclose(data["tga_5K"], columns["tga_5K"])
    assert np.allclose(data["tga_20K"]["mass_fraction"], columns["tga_20K"][:, 2])


def test_table_of_a_slab_holds_all_its_signals() -> None:
    time = np.arange(0.0, 600.0, 5.0)
    columns = {"Time (s)": time, "Mass (g)": 40.0 - 0.02 * time, "Back Temp (C)": 20.0 + 0.1 * time}
    tables = {"slab_25kW": pd.DataFrame(columns)}
    with pytest.warns(UserWarning, match="data of slab_25kW: no flux is given"):
        study = pf.new_study("wood", gasification=tables)
    assert len(study.experiments["slab_25kW"].signals) == 2
    data = pf.read_data(study, data=tables)
    assert set(data) == {("slab_25kW", s) for s in study.experiments["slab_25kW"].signals}
    assert np.allclose(data["slab_25kW", "back_temperature"].iloc[:, 1], 293.15 + 0.1 * time)


def test_study_of_series_in_memory_says_so_where_they_are_not_given(tmp_path: Path) -> None:
    study = pf.new_study("wood", tga=arrays())
    with pytest.raises(DataError, match=r"tga_5K\.signals.* in memory alone; give it as `data`"):
        pf.read_data(study, "tga_5K")
    again = pf.read_study(pf.write_study(study, tmp_path / "wood.yaml"))
    assert again.experiments == study.experiments


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"a": np.ones((5, 7))}, r"data of a: an array of the shape \(5, 7\)"),
        ({"a": "nowhere.csv"}, r"nowhere\.csv"),
        ({"a": pd.DataFrame({"x": []})}, "data of a"),
    ],
)
def test_wrong_table_is_named_by_its_experiment(given: object, message: str) -> None:
    with pytest.raises((DataError, StudyError), match=message):
        pf.new_study("wood", tga=given)


def test_times_in_minutes_and_a_missing_column_are_told() -> None:
    T = np.linspace(400.0, 850.0, 200)
    mass = 1.0 / (1.0 + np.exp((T - 640.0) / 12.0))
    table = pd.DataFrame({"time_s": T - T[0], "temperature_K": T, "mass_fraction": mass})
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        pf.new_study("x", tga={"tga_1K": table})
        pf.new_study("x", tga={"tga_60K": table.drop(columns="temperature_K")})
    said = [str(one.message) for one in told]
    assert any("data of tga_1K: the record shows a heating rate of 60 K/min" in one for one in said)
    assert any("data of tga_60K: there is no column of the temperature" in one for one in said)


def test_a_gas_with_oxygen_is_told_by_draft_and_fit() -> None:
    table = as_recorded("tga_air_5K", next(iter(arrays().values())))
    with pytest.warns(UserWarning, match="The gas is air: the model has no oxidation"):
        study = pf.new_study("plastic", tga={"tga_air_5K": table})
    with (
        pytest.warns(UserWarning, match="tga_air_5K: the gas is air, and the model has no oxid"),
        pytest.raises((StudyError, DataError)),
    ):
        pf.fit(study)
