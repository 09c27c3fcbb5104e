"""Every set under every cost, tests of the cost functions, good sets, and what is said of them."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from shown_studies import comparison, described, fake, made
from stage_studies import SETS, by_hand, estimated_by_hand, parameters, study_with
from valley import Valley

from pyrofit.analysis import good_sets as family
from pyrofit.analysis import groups
from pyrofit.analysis.rank_correlation import rank_correlation
from pyrofit.config import Study, as_study
from pyrofit.errors import DataError
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.quantities import known_quantities
from pyrofit.results import recorded, searches
from pyrofit.results.files import Results, read_csv, write_csv
from pyrofit.show.facts import facts_of
from pyrofit.show.sections import TABLES
from pyrofit.show.subjects.costs.sentences import reach_of_good_sets as good_sets
from pyrofit.show.subjects.costs.sentences import sentences as costs
from pyrofit.show.subjects.optimisation.sentences import sentences as optimisers
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages import compare, fit, measurements, predict

# --- the family of good sets ----------------------------------------------------------------


def explored(top: float, problem: Any = None, seed: int = 1) -> tuple[FloatArray, FloatArray]:
    problem = problem or Valley()
    best = np.array(problem.optimum)
    return family.walk_about(problem, best, top, np.random.default_rng(seed))


def test_walk_meets_good_sets_alone_and_the_best_first() -> None:
    costs, sets = explored(0.1)
    assert np.all(costs <= 0.1)
    assert costs[0] == 0.0
    assert sets[0] == pytest.approx([0.3, -20.0])
    problem = Valley()
    assert costs == pytest.approx([np.linalg.norm(problem.residuals(x)) for x in sets], abs=1e-12)


def test_walk_reaches_all_ends_of_what_is_good() -> None:
    # The good sets of a valley are an ellipse of half axes 0.1 of the search range.
    _, sets = explored(0.1)
    assert 0.9 * 0.2 < np.ptp(sets[:, 0]) <= 0.2
    assert 0.9 * 12.0 < np.ptp(sets[:, 1]) <= 12.0


def test_walk_follows_a_narrow_oblique_valley() -> None:
    class Narrow(Valley):
        def residuals(self, x: FloatArray) -> FloatArray:
            u, v = super().residuals(x)
            return np.array([100.0 * (u - v), u + v])

    _, sets = explored(0.1, Narrow())
    # It is 0.1 of the limits long and a hundredth of that wide.
    assert np.ptp(sets[:, 0]) > 0.05
    assert np.ptp(sets[:, 1]) > 3.0


def test_walk_begins_in_a_corner_of_the_limits() -> None:
    problem = Valley()
    corner = np.array(problem.lower)
    costs, sets = family.walk_about(problem, corner, 0.0, np.random.default_rng(1))
    assert np.all(costs[1:] <= 0.0)
    assert np.array_equal(sets[0], corner)


def test_walk_stays_within_the_limits_where_nothing_is_bad() -> None:
    problem = Valley()
    _, sets = explored(1e9, problem)
    assert np.all(sets >= problem.lower)
    assert np.all(sets <= problem.upper)
    assert np.all(np.ptp(sets, axis=0) > 0.9 * (problem.upper - problem.lower))


def test_walk_draws_by_its_generator_alone() -> None:
    assert np.array_equal(explored(0.1)[1], explored(0.1)[1])
    assert not np.array_equal(explored(0.1)[1][:9], explored(0.1, seed=2)[1][:9])


def test_chosen_sets_are_few_and_lie_apart() -> None:
    scaled = np.random.default_rng(1).random((500, 2))
    chosen = family.farthest_apart(scaled)
    assert chosen[0] == 0
    assert len(set(chosen.tolist())) == chosen.size == family.MOST
    apart = scaled[chosen]
    nearest = [np.sort(np.linalg.norm(apart - x, axis=1))[1] for x in apart]
    # Of points on a grid of 60 in a square the nearest are 0.13 apart.
    assert min(nearest) > 0.06


# --- tests of groups ------------------------------------------------------------------------


def test_equal_groups_do_not_differ() -> None:
    same = [np.ones(6), np.ones(6)]
    assert groups.location(same) == (1.0, 0.0)
    assert groups.pair(*same) == (1.0, 0.0)
    assert groups.spread_test(same) == 1.0


def test_groups_that_lie_apart_differ_in_place_and_not_in_scatter() -> None:
    x = np.arange(9.0)
    p, share = groups.location([x, x + 20.0, x + 40.0])
    assert p < 1e-4
    assert share > 0.85
    assert groups.spread_test([x, x + 20.0, x + 40.0]) == pytest.approx(1.0)
    assert groups.pair(x + 20.0, x)[1] == 1.0


def test_a_group_of_one_value_differs_in_scatter_from_one_that_scatters() -> None:
    assert groups.spread_test([np.zeros(9), np.arange(9.0) - 4.0]) < 0.01
    assert groups.spread_test([np.zeros(4), np.array([1.0, -1.0, 1.0, -1.0])]) == 0.0


def test_too_few_values_are_not_tested() -> None:
    assert groups.enough([np.ones(5), np.ones(5)])
    assert not groups.enough([np.ones(5), np.ones(4)])
    assert not groups.enough([np.ones(5)])


def test_corrected_probabilities_keep_their_order_and_do_not_exceed_one() -> None:
    assert groups.holm([]) == []
    assert groups.holm([0.9, 0.8]) == [1.0, 1.0]
    # 0.01 * 3; 0.02 * 2; max(0.03 * 1, 0.04).
    assert groups.holm([0.03, 0.01, 0.02]) == pytest.approx([0.04, 0.03, 0.04])


# --- the stage ------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def study() -> Study:
    return study_with()


@pytest.fixture(scope="module")
def results(study: Study, tmp_path_factory: pytest.TempPathFactory) -> Results:
    """Return the results of the step, after searches made by hand."""
    results = Results(tmp_path_factory.mktemp("results"))
    measurements.prepare(study, results)
    estimated_by_hand(results, {"T_p": 605.0, "E_p": 190e3}, "kinetics")
    by_hand(study, results)
    estimated_by_hand(results, parameters("RMSE", 9))
    fit.collect(study, results)
    compare.compare(study, results)
    return results


def scores(results: Results) -> pd.DataFrame:
    return read_csv(results.comparison("scores.csv"))


def test_every_end_of_every_optimiser_is_judged(study: Study, results: Results) -> None:
    here = scores(results).query("place == 'fitted' and measure == 'RMSE'")
    # Two repetitions, two starts of least squares and one of CMA-ES for each of three costs.
    assert len(here) == 3 * (2 + 2 + 1)
    assert here["best"].sum() == 3 * 3
    best = here[here["best"] & (here["found_by"] == "SCE-UA")].set_index("cost_function")
    assert best["number"].to_dict() == {"RMSE": 1, "RANGE": 0, "BANDS": 0}


@pytest.mark.parametrize("cost", SETS)
def test_cost_of_a_set_is_that_which_the_searches_minimise(
    study: Study, results: Results, cost: str
) -> None:
    found = compare.ends(study, searches.read(study, results, OPTIMISERS))
    problem = fit.imp_problem(study, results, cost)
    here = scores(results).query(f"place == 'fitted' and measure == '{cost}'")
    for value, (_, row) in zip(here["value"], found.iterrows(), strict=True):
        x = row[list(problem.names)].to_numpy(float)
        assert value == pytest.approx(problem.evaluate(x).cost, rel=1e-12)


def test_metric_of_a_best_set_is_the_score_of_its_prediction(
    study: Study, results: Results
) -> None:
    predict.predict_sets(study, results)
    predicted = read_csv(results.validation("scores.csv"))
    for place in ("slab_25", "slab_60"):
        here = scores(results).query(f"place == '{place}' and best and found_by == 'SCE-UA'")
        rate = here[here["measure"] == known_quantities()["mlr"].metric].set_index("cost_function")[
            "value"
        ]
        kelvin = here[here["measure"] == known_quantities()["back_temperature"].metric]
        theirs = predicted[(predicted["experiment"] == place) & predicted["set"].isin(list(SETS))]
        by_signal = theirs.set_index(["signal", "set"])
        for cost in SETS:
            expected = by_signal.loc[("mlr", cost), "cv_rmse"]
            assert rate[cost] == pytest.approx(expected, rel=1e-9)
            expected = by_signal.loc[("back_temperature", cost), "rmse_si"]
            value = kelvin.set_index("cost_function")["value"][cost]
            assert value == pytest.approx(expected, rel=1e-9)


def test_costs_are_carried_over_to_what_was_not_fitted_alone(
    study: Study, results: Results
) -> None:
    found = compare.places(study, recorded.load(study, results))
    metrics = {known_quantities()["mlr"].metric, known_quantities()["back_temperature"].metric}
    assert set(found) == {"fitted", "slab_25", "slab_60"}
    assert set(found["slab_25"]) == metrics
    assert set(found["slab_60"]) == metrics | set(SETS)
    assert {t.experiment for terms in found["slab_60"].values() for t in terms} == {"slab_60"}


def test_cost_that_cannot_be_computed_elsewhere_is_left_out(study: Study, results: Results) -> None:
    series = recorded.load(study, results)
    bare = series["slab_60", "mlr"].drop(columns="mlr_uncertainty_kg_m2_s")
    found = compare.places(study, {**series, ("slab_60", "mlr"): bare})
    assert "BANDS" not in found["slab_60"]
    assert "RMSE" in found["slab_60"]


def test_good_sets_begin_with_the_lowest_cost_known_and_are_good(
    study: Study, results: Results
) -> None:
    table = read_csv(results.comparison("family.csv"))
    here = scores(results).query("place == 'fitted'")
    for cost, group in table.groupby("cost_function"):
        lowest = here.loc[here["measure"] == cost, "value"].min()
        assert group["cost"].iloc[0] == pytest.approx(lowest, rel=1e-12)
        assert group["cost"].max() <= family.GOOD * lowest * (1.0 + 1e-12)
        assert 5 < len(group) <= min(family.MOST, group["met"].iloc[0])
        problem = fit.imp_problem(study, results, str(cost))
        last = group[list(problem.names)].iloc[-1].to_numpy(float)
        assert problem.evaluate(last).cost == pytest.approx(group["cost"].iloc[-1], rel=1e-12)


def test_bands_hold_the_best_set_between_their_edges(results: Results) -> None:
    bands = read_csv(results.comparison("bands.csv"))
    assert set(bands["experiment"]) == {"slab_25", "slab_60"}
    assert set(bands["signal"]) == {"mlr", "back_temperature"}
    assert (bands["low"] <= bands["best"]).all()
    assert (bands["best"] <= bands["high"]).all()
    assert (bands["high"] - bands["low"]).max() > 0.0


def test_missing_results_of_cmaes_are_told(study: Study, tmp_path: Path) -> None:
    results = Results(tmp_path)
    by_hand(study, results)
    fit.collect(study, results)
    results.starts("RANGE", "cmaes").unlink()
    with pytest.raises(DataError, match=r"RANGE/cmaes\.json: this result is missing"):
        compare.ends(study, searches.read(study, results, OPTIMISERS))


# --- tables ---------------------------------------------------------------------------------


def test_every_best_set_stands_under_every_cost_by_hand(tmp_path: Path) -> None:
    table = made("every_cost", *fake(tmp_path)).set_index(["place", "fitted_with", "found_by"])
    costs = table[["RMSE", "BANDS"]]
    assert costs.loc[("fitted", "RMSE", "least squares")].tolist() == [0.08, 0.09]
    assert costs.loc[("fitted", "BANDS", "SCE-UA")].tolist() == [0.11, 0.10]
    # Published values are complete for RMSE alone; at the fitted experiment no cost is repeated.
    assert ("fitted", "RMSE", "published") in table.index
    assert ("fitted", "BANDS", "published") not in table.index
    row = table.loc[("Slab 25 kW/m²", "RMSE", "CMA-ES")]
    assert row[["RMSE", "BANDS"]].isna().all()
    assert row[known_quantities()["mlr"].metric] == pytest.approx(0.185)


def test_too_few_repetitions_are_not_tested(tmp_path: Path) -> None:
    table = made("cost_tests", *fake(tmp_path))
    assert "p_place" not in table
    assert set(table["verdict"]) == {"not tested: fewer than 5 repetitions"}


def with_repetitions(folder: Path, shift: float) -> tuple[Study, Results]:
    """Eight repetitions each; with BANDS k lies higher by ``shift`` and cp scatters ten times."""
    given = described()
    given["imp"]["repetitions"] = 8
    study, results = fake(folder, given)
    rng = np.random.default_rng(1)
    rows, running = [], []
    for cost in study.imp.costs:
        other = cost == "BANDS"
        for n in range(8):
            k = 0.3 + 0.001 * rng.standard_normal() + shift * other
            cp = 2000.0 + (-1.0) ** n * (100.0 + n if other else 10.0)
            row = {"cost_function": cost, "repetition": n, "cost": 0.1, "cost_refined": 0.1}
            rows.append({**row, "calls": 100, "failed_calls": 0, "k": k, "cp": cp})
            steps = {"generation": [1, 2, 3], "calls": [30, 60, 100], "best_cost": [1.0, 0.1, 0.1]}
            running.append(pd.DataFrame(steps).assign(cost_function=cost, repetition=n))
    write_csv(results.imp("summary.csv"), pd.DataFrame(rows))
    write_csv(results.imp("convergence.csv"), pd.concat(running))
    comparison(study, results)
    return study, results


def test_difference_in_place_and_in_scatter_is_found_where_it_is(tmp_path: Path) -> None:
    table = made("cost_tests", *with_repetitions(tmp_path, 0.02)).set_index("quantity")
    assert table.loc["k", "verdict"] == "differ in place"
    assert table.loc["k", "pairs"] == "RMSE–BANDS −1.00"
    assert table.loc["cp", "verdict"] == "differ in scatter"
    # Limits 0.1 to 0.5, interval 0.1 of that: 0.02 are 5 % of the one and 50 % of the other.
    assert table.loc["k", "of_limits"] == pytest.approx(5.0, abs=0.5)
    assert table.loc["k", "of_interval"] == pytest.approx(50.0, abs=5.0)
    speed = table.loc["generations to within 1 % of the end"]
    assert [speed["median RMSE"], speed["verdict"]] == [2.0, "no difference shown"]


def test_no_difference_is_found_where_there_is_none(tmp_path: Path) -> None:
    table = made("cost_tests", *with_repetitions(tmp_path, 0.0)).set_index("quantity")
    assert table.loc["k", "verdict"] == "no difference shown"
    assert pd.isna(table.loc["k", "pairs"])


def test_one_cost_function_has_nothing_to_differ_from() -> None:
    given = described()
    del given["imp"]["costs"]["BANDS"]
    assert not TABLES["cost_tests"].applies(as_study(given, "fake.json"))


def test_bands_by_hand(tmp_path: Path) -> None:
    table = made("bands", *fake(tmp_path))
    rate = table[(table["experiment"] == "Slab 25 kW/m²")].set_index("cost_function")
    assert rate["good_sets"].to_dict() == {"RMSE": 40, "BANDS": 41, "all": 81}
    assert rate["simulated"].to_dict() == {"RMSE": 10, "BANDS": 10, "all": 20}
    # 19 of 20 points inside; 2 % and 3 % of all but the first point, which is 5 of a sum of 1050.
    assert rate["within_percent"].tolist() == [95.0] * 3
    wide = 1045 / 1050
    assert rate["width_percent"].tolist() == pytest.approx([2 * wide, 3 * wide, 3 * wide])
    # The first point is missed by 1 % of 5e-4, its uncertainty is 2e-4.
    assert rate["within_with_uncertainty_percent"].tolist() == [100.0] * 3


def test_rank_correlation_knows_nothing_of_what_the_costs_differ_in(tmp_path: Path) -> None:
    study, results = with_repetitions(tmp_path, 0.1)
    summary = read_csv(results.imp("summary.csv"))
    # Within each cost cp falls where k rises; between them both rise.
    within = summary.groupby("cost_function")["k"].rank()
    summary["cp"] = 1000.0 * (summary["cost_function"] == "BANDS") - within
    write_csv(results.imp("summary.csv"), summary)
    matrix = rank_correlation(study, results)
    assert matrix.loc["k", "cp"] == pytest.approx(-1.0)
    summary["cp"] = 1500.0
    write_csv(results.imp("summary.csv"), summary)
    assert rank_correlation(study, results).loc["k", "cp"] == 0.0


# --- sentences ------------------------------------------------------------------------------


def said(study: Study, results: Results) -> str:
    names = ("costs", "every_cost", "cost_tests", "bands")
    tables = {n: TABLES[n].make(study, results) for n in names}
    facts = facts_of(study, results, tables)
    return " ".join([*optimisers(study, facts), *costs(study, facts), good_sets(tables)])


def test_sentences_say_the_numbers(tmp_path: Path) -> None:
    text = said(*fake(tmp_path))
    for claim in (
        "find lower values of the same costs: RMSE by 20 %, 1 of 2 starts of least squares agree",
        "For each cost function, no set beats the best one fitted with it by more than 1 %.",
        "not tested: fewer than 5 repetitions",
        "mass loss rate at Slab 25 kW/m² 3 % of the mean (95 % of the measured points lie inside)",
    ):
        assert claim in text
    assert "Wall times" not in text


def test_sentences_name_a_set_that_is_better_under_another_cost(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    table = scores(results)
    mine = (table["place"] == "fitted") & (table["measure"] == "BANDS")
    theirs = mine & (table["cost_function"] == "RMSE") & (table["found_by"] == "CMA-ES")
    table.loc[theirs, "value"] = 0.01
    write_csv(results.comparison("scores.csv"), table)
    assert (
        "under BANDS the set fitted with RMSE by CMA-ES has 0.01, those fitted with BANDS 0.08 at"
    ) in said(study, results)


def test_sentences_say_differences_with_their_sizes(tmp_path: Path) -> None:
    text = said(*with_repetitions(tmp_path, 0.02))
    assert "Holm-corrected): k (medians 0.0" in text
    assert "% of the search range, " in text
    assert "Their scatter differs in cp (Brown and Forsythe's test)." in text


def test_wall_times_are_those_of_the_benchmarks(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    for name in ("imp_{}_00", "imp_{}_01", "least_squares_{}", "cmaes_{}"):
        for cost in study.imp.costs:
            path = results.root / "benchmarks" / f"{name.format(cost)}.tsv"
            path.parent.mkdir(exist_ok=True)
            path.write_text("s\th:m:s\n10.5\t0:00:10\n")
    assert (
        "Wall times of this run, all cost functions: SCE-UA 42 s in 4 jobs, least squares 21 s in "
        "2 jobs, CMA-ES 21 s in 2 jobs."
    ) in said(study, results)
