"""Files of other people's predictions: names, columns, units, and what is refused."""

from pathlib import Path

import numpy as np
import pytest

from pyrofit.errors import DataError
from pyrofit_compare.others import matching, read_prediction, read_predictions
from pyrofit_compare.score import mean_of

ROWS = "0,72.0,293,293\n1,71.9,294,300\n2,71.7,295,310\n"


@pytest.mark.parametrize(
    ("name", "head"),
    [
        ("UMD_Gasification_65kW_6mm", "Time,Sample Mass, Back surface Temperature, Top (1mm)\n"),
        ("BUW-FZJ_A_Gasification_65kw_6mm", "Time,ResidualMass,Avg_Back_Wall_Temp,Front\n"),
        ("X_Gasification_q65_Mass_R3", "Time,Mass,T_back_1,T_top\n"),
    ],
)
def test_names_and_columns_of_macfp(tmp_path: Path, name: str, head: str) -> None:
    path = tmp_path / f"{name}.csv"
    path.write_text(head + "[s],[g],[K],[K]\n" + ROWS)
    curves = {c.quantity: c for c in read_prediction(path, 0.01)}
    assert set(curves) == {"mass", "back_temperature", "front_temperature"}
    assert curves["mass"].value[0] == pytest.approx(7.2)
    assert curves["mass"].who == name.split("_Gas")[0]
    assert curves["mass"].flux_W_m2 == 65e3
    assert np.isnan(curves["mass"].thickness_m) == ("mm" not in name)


def test_units_may_come_first_and_rates_follow_from_masses(tmp_path: Path) -> None:
    path = tmp_path / "NIST_Gasification_65kW_6mm.csv"
    path.write_text('s,[g],[K],[K]\nTime,"Mass","Back Temperature","Top Temperature"\n' + ROWS)
    curves = read_prediction(path, 0.01)
    (rate,) = matching(curves, 65e3, 6e-3, "mlr")
    np.testing.assert_allclose(rate.value, [0.01, 0.02])
    np.testing.assert_allclose(rate.time_s, [0.5, 1.5])
    assert [c.quantity for c in matching(curves, 65e3, 6e-3, "interface_temperature")] == [
        "back_temperature"
    ]
    assert not matching(curves, 60e3, 6e-3, "mass")
    assert not matching(curves, 65e3, 12e-3, "mass")


def test_what_is_refused_and_what_a_folder_leaves_out(tmp_path: Path) -> None:
    path = tmp_path / "slab.csv"
    path.write_text("Time,Mass\n[s],[g]\n0,1\n1,1\n2,1\n")
    with pytest.raises(DataError, match=r"slab.csv: the name states no institute and flux. Rename"):
        read_prediction(path, 0.01)
    wrong = tmp_path / "A_Gasification_q50.csv"
    wrong.write_text("Time,foo\n[s],[g]\n0,1\n1,2\n2,1\n")
    with pytest.raises(DataError, match=r"A_Gasification_q50.csv: no column is known: Time, foo"):
        read_predictions([tmp_path], 0.01)
    good = tmp_path / "B_Gasification_q50.csv"
    good.write_text("Time,Mass\n[s],[g]\n0,3\n1,2\n2,1\n")
    found = read_predictions([tmp_path], 0.01)
    assert [c.who for c in found.curves] == ["B"]
    assert len(found.left) == 1


def test_repeats_that_do_not_overlap_are_refused() -> None:
    t = np.arange(5.0)
    with pytest.raises(DataError, match="0 times in common"):
        mean_of([(t, t), (t + 10.0, t)])
    with pytest.raises(DataError, match="constant"):
        mean_of([(t, np.ones(5))])
