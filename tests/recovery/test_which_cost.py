"""The experiment of docs/which_cost.md: its twins, its costs, what it writes, and its counts."""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import which_cost
import which_cost_cases
import which_cost_numbers
import which_cost_report
from which_cost_cases import ESTIMATED, Case, Posed, cases_of, posed

CASE = Case("right", "measured", 0)


@pytest.fixture(scope="module")
def small() -> object:
    """Cheaper twins and searches."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(which_cost_cases, "ELEMENTS", 60)
        patch.setattr(which_cost, "STARTS", {"least squares": 1, "CMA-ES": 1})
        patch.setattr(which_cost, "CALLS", 300)
        yield patch


@pytest.fixture(scope="module")
def twin(small: object) -> Posed:
    return posed(CASE, Path())


def test_outliers_are_the_noise_as_measured_with_one_point_in_twenty_moved(twin: Posed) -> None:
    moved = posed(Case("right", "outliers", 0), Path()).series["capa_25", "mlr"]["mlr_kg_m2_s"]
    by = np.abs(moved - twin.series["capa_25", "mlr"]["mlr_kg_m2_s"])
    assert np.count_nonzero(by) == round(0.05 * by.size)
    np.testing.assert_allclose(by[by > 0.0], 10.0 * 2.9e-4)


def test_all_noises_of_a_number_share_one_truth(twin: Posed) -> None:
    other = posed(Case("right", "white", 0), Path())
    assert twin.truth is not None
    np.testing.assert_array_equal(twin.truth, other.truth)
    for key, frame in twin.compared.items():
        pd.testing.assert_frame_equal(frame, other.compared[key])
    measured, white = (of.series["capa_25", "mlr"]["mlr_kg_m2_s"] for of in (twin, other))
    assert np.all(measured != white)


def test_truth_of_the_twin_predicts_itself(twin: Posed) -> None:
    assert twin.truth is not None
    away = 1.1 * twin.truth
    errors = which_cost.predicted(twin, np.array([twin.truth, away]))
    assert np.all(errors.iloc[0] < 0.01)
    assert np.all(errors.iloc[1] > 0.01)


def test_a_case_is_fitted_searched_and_kept(small: object, tmp_path: Path) -> None:
    which_cost.run(CASE, tmp_path, ("chi2_all",))
    ends = pd.read_csv(tmp_path / "ends" / f"{CASE.id}.csv")
    assert list(ends["optimiser"]) == ["least squares", "CMA-ES", "best"]
    best = ends.iloc[-1]
    assert best["value"] == ends["value"].min()
    assert best["value"] == pytest.approx(720, rel=0.15), "chi-square of 720 points"
    assert abs(best["x_rho_a"]) < 0.02
    assert abs(best["x_dh"]) < 0.05
    assert best["unseen_mlr"] < 0.1
    intervals = pd.read_csv(tmp_path / "intervals" / f"{CASE.id}.csv")
    assert tuple(intervals["parameter"]) == ESTIMATED
    assert np.all(intervals["low"] < intervals["high"])


def test_every_search_that_is_repeated_is_part_of_the_full_plan() -> None:
    full = list(cases_of("full"))
    assert len({case.id for case in full}) == len(full)
    assert sum(case.repetitions > 0 for case in full) == len(which_cost_cases.REPEATED)


def ends_by_hand() -> pd.DataFrame:
    """Return two twins: SCE-UA twice each, and best sets of RMSE twice as far off as chi2's."""
    rows = []
    for number in (0, 1):
        about = {"kind": "right", "name": "white", "number": number, "group": "white"}
        for x in (-0.01, 0.03 - 0.05 * number):
            away = {"x_k_a": x, "x_k_r": 0.5}
            rows.append({**about, "cost": "RMSE", "optimiser": "SCE-UA", **away})
        for cost, x in (("RMSE", 0.4), ("chi2", 0.2)):
            away = {"x_k_a": x, "x_k_r": 0.5}
            rows.append({**about, "cost": cost, "optimiser": "best", **away})
    return pd.DataFrame(rows)


def test_spans_of_repetitions_that_hold_the_truth_are_counted() -> None:
    assert "| `RMSE` | 1/2, 50% (1% to 99%) | - |" in which_cost_report.spans(ends_by_hand())


def test_errors_are_compared_case_by_case() -> None:
    best = which_cost_numbers.estimates(ends_by_hand())
    np.testing.assert_allclose(which_cost_numbers.ratios(best, "error", ["white"], "RMSE"), 2.0)
    assert which_cost_numbers.bootstrapped(np.full(3, 2.0)) == pytest.approx((2.0, 2.0, 2.0))
