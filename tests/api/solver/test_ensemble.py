"""Simulations of many parameter sets at once."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import pyrofit as pf
from pyrofit.errors import StudyError

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"
NAMES = ["T_p", "E_p", "rho", "k", "cp", "eps", "dh"]
TRUTH = [605.0, 190.0, 1190.0, 0.2, 2.1, 0.9, 800.0]


@pytest.fixture(scope="module")
def study() -> pf.Study:
    return pf.read_study(SMOKE)


def sets(count: int) -> pd.DataFrame:
    spread = 1.0 + 0.02 * np.random.default_rng(0).standard_normal((count, len(NAMES)))
    return pd.DataFrame(TRUTH * spread, columns=NAMES, index=[f"s{i}" for i in range(count)])


def test_sets_side_by_side_have_the_curves_of_each_alone(study: pf.Study) -> None:
    table = sets(11)
    many = pf.simulate(study, table, experiments=["tga_5K", "slab_60"])
    assert many.keys() == [("tga_5K", "mass_fraction"), *many.keys()[1:]]
    for label, row in table.iterrows():
        one = pf.simulate(study, row.to_dict(), experiments=["tga_5K", "slab_60"])
        for key in many:
            assert np.array_equal(many[key][label], one[key].iloc[:, -1])
            assert np.array_equal(many[key].index.get_level_values("time_s"), one[key]["time_s"])
    mass = many["tga_5K", "mass_fraction"]
    assert np.array_equal(mass.index.get_level_values("temperature_K")[[0, 1]], [450.0, 452.0])
    assert many.failed.empty


def test_table_of_all_values_has_a_row_for_each_set_and_time(study: pf.Study) -> None:
    many = pf.simulate(study, sets(2), experiments="slab_60")
    frame = many.frame
    rate = frame[(frame["set"] == "s1") & (frame["signal"] == "mlr")]
    assert np.array_equal(rate["value"], many.arrays["slab_60", "mlr"][1])
    assert rate["unit"].unique().tolist() == ["kg/(m2 s)"]
    assert rate["temperature_K"].isna().all()
    assert len(frame) == 2 * sum(a.shape[1] for a in many.arrays.values())
    assert repr(many).startswith("2 sets of study 'smoke', simulated\n  slab_60, mlr: 80 points")


def test_set_that_does_not_finish_is_named_and_the_others_stay(study: pf.Study) -> None:
    table = sets(3)
    table.loc["s1", "dh"] = -1e6
    many = pf.simulate(study, table, experiments=["tga_5K", "slab_60"])
    assert many.failed.index.tolist() == ["s1"]
    assert many.failed["s1"].startswith("experiments.slab_60: a temperature left the range")
    rates = many["slab_60", "mlr"]
    assert rates.isna().all().tolist() == [False, True, False]
    assert not many["tga_5K", "mass_fraction"].isna().any().any()
    assert "1 of which failed" in repr(many)


def test_sets_are_simulated_at_measured_times(study: pf.Study) -> None:
    T = np.array([500.0, 600.0, 640.0])
    data = {"tga_5K": np.column_stack([12.0 * (T - 500.0), T, [1.0, 0.8, 0.1]])}
    many = pf.simulate(study, sets(4)[["T_p", "E_p"]], data=data)
    assert many["tga_5K", "mass_fraction"].shape == (3, 4)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (sets(0), "values: the table has no row"),
        (sets(2).rename(columns={"k": "kk"}), "no parameter 'kk'. Did you mean 'k'"),
        (sets(2).rename(columns={"k": "cp"}), "values: two columns are named 'cp'"),
        (sets(2).drop(columns="k"), "no value for k"),
        (sets(2).assign(k=[0.2, np.nan]), "values: row s1, parameter 'k': nan is no finite"),
        (sets(2).assign(k=["a", "b"]), "cells that are no numbers"),
        (sets(2).assign(k=[0.2, -0.1]), "'k': -0.1 must be above 0"),
    ],
)
def test_wrong_table_of_sets_is_explained(
    table: pd.DataFrame, message: str, study: pf.Study
) -> None:
    with pytest.raises(StudyError, match=message):
        pf.simulate(study, table)


def test_series_that_was_not_simulated_is_named(study: pf.Study) -> None:
    many = pf.simulate(study, sets(2), experiments="slab_60")
    with pytest.raises(StudyError, match="no simulated series 'slab_60'; name a pair"):
        many["slab_60"]
