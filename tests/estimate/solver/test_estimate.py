"""The optimisers on problems of known optimum, and the problem they are given."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import spotpy
from valley import Valley

from pyrofit.config import Study, TermSpec, read_study
from pyrofit.errors import CostError
from pyrofit.estimate import cmaes
from pyrofit.estimate.history import best_of, convergence
from pyrofit.estimate.least_squares import multistart
from pyrofit.estimate.problem import FAILED_COST, Evaluation, Problem, make_problem
from pyrofit.estimate.sceua import search, search_several
from pyrofit.estimate.targets import target_of
from pyrofit.experiments import KINDS, Tga
from pyrofit.experiments.heated.simulate import programme, request
from pyrofit.quantities import known_quantities
from pyrofit.seeds import seed_for
from pyrofit.simulate import simulate_gasification, simulate_tga
from pyrofit.solver.arrays import FloatArray, Status
from pyrofit.solver.curves import Request

CONFIG = Path(__file__).parents[3] / "config"
GENERATIONS = 5
COMPLEXES = 2


class Watched(Valley):
    """The same, which notes the sets whose residuals are asked for, too."""

    def residuals(self, x: FloatArray) -> FloatArray:
        self.asked.append(x.copy())
        return super().residuals(x)

    def evaluate(self, x: FloatArray) -> Evaluation:
        cost = float(np.linalg.norm(self.residuals(x)))
        return Evaluation(cost, (cost,), Status.OK)


def run(problem: Any, seed: int = 1, generations: int = GENERATIONS) -> pd.DataFrame:
    return search(problem, seed, generations, COMPLEXES)


# --- SCE-UA ---------------------------------------------------------------------------------


def test_equal_seeds_give_equal_bits() -> None:
    pd.testing.assert_frame_equal(run(Valley()), run(Valley()), check_exact=True)


def test_different_seeds_give_different_histories() -> None:
    assert not np.array_equal(run(Valley(), 1)["a"], run(Valley(), 2)["a"])


def test_search_depends_on_nothing_drawn_before() -> None:
    first = run(Valley())
    np.random.seed(99)  # noqa: NPY002
    np.random.random(17)  # noqa: NPY002
    pd.testing.assert_frame_equal(first, run(Valley()), check_exact=True)


def test_search_leaves_the_generator_of_its_caller_as_it_was() -> None:
    np.random.seed(5)  # noqa: NPY002
    expected = np.random.random(2)[1]  # noqa: NPY002
    np.random.seed(5)  # noqa: NPY002
    np.random.random()  # noqa: NPY002
    run(Valley())
    assert np.random.random() == expected  # noqa: NPY002


def test_searches_side_by_side_have_the_bits_of_each_alone() -> None:
    # Some end earlier than others.
    seeds = [1, 2, 3, 1]
    together = search_several(Valley(), seeds, GENERATIONS, COMPLEXES)
    for seed, found in zip(seeds, together, strict=True):
        pd.testing.assert_frame_equal(found, run(Valley(), seed), check_exact=True)


class Plain:
    """A setup as SPOTPY describes it."""

    def __init__(self, problem: Valley) -> None:
        limits = zip(problem.names, problem.lower.tolist(), problem.upper.tolist(), strict=True)
        self.problem = problem
        self.distributions = [
            spotpy.parameter.Uniform(n, low, high, minbound=low, maxbound=high)
            for n, low, high in limits
        ]

    def parameters(self) -> Any:
        return spotpy.parameter.generate(self.distributions)

    def simulation(self, vector: Any) -> list[float]:
        return [self.problem.evaluate(np.array(list(vector))).cost]

    def evaluation(self) -> list[float]:
        return [0.0]

    def objectivefunction(
        self, simulation: list[float], evaluation: Any, params: Any = None
    ) -> float:
        return simulation[0]


@pytest.mark.parametrize("optimum", [(0.3, -20.0), (0.0, 10.0)], ids=["inside", "at the limits"])
def test_search_asks_what_spotpy_asks_with_all_it_makes_for_each_call(
    optimum: tuple[float, ...],
) -> None:
    ours, plain = Valley(optimum), Valley(optimum)
    run(ours, 7)
    spotpy.algorithms.sceua(Plain(plain), dbformat="ram", random_state=7).sample(
        10**9,
        ngs=COMPLEXES,
        kstop=GENERATIONS + 1,
        pcento=1e-12,
        peps=1e-12,
        max_loop_inc=GENERATIONS - 1,
    )
    assert np.array_equal(ours.asked, plain.asked)


def test_history_holds_every_call_in_order() -> None:
    problem = Valley()
    history = run(problem)
    assert list(history.columns) == ["call", "generation", "cost", "status", "cost_0", "a", "b"]
    assert history["call"].tolist() == list(range(1, len(problem.asked) + 1))
    assert np.array_equal(history[["a", "b"]].to_numpy(), np.array(problem.asked))


def test_generations_run_from_the_burn_in_to_the_number_asked_for() -> None:
    history = run(Valley())
    assert history["generation"].is_monotonic_increasing
    assert history["generation"].unique().tolist() == [1, 2, 3, 4, 5]


def test_burn_in_draws_2n_plus_1_points_for_each_complex() -> None:
    assert (run(Valley())["generation"] == 1).sum() == (2 * 2 + 1) * COMPLEXES


def test_each_generation_makes_at_least_2n_plus_1_calls_for_each_complex() -> None:
    counts = run(Valley())["generation"].value_counts()
    assert counts.min() >= (2 * 2 + 1) * COMPLEXES


def test_number_of_complexes_is_the_number_of_parameters_by_default() -> None:
    history = search(Valley(), 1, 3)
    assert (history["generation"] == 1).sum() == (2 * 2 + 1) * 2


def test_all_points_lie_inside_the_limits() -> None:
    problem = Valley(optimum=(0.0, 10.0))
    run(problem)
    points = np.array(problem.asked)
    assert np.all(points >= problem.lower)
    assert np.all(points <= problem.upper)


def test_search_comes_close_to_the_optimum() -> None:
    problem: Any = Valley()
    cost, x = best_of(search(problem, 3, 15, 2), problem)
    assert cost == pytest.approx(0.0, abs=1e-3)
    assert x == pytest.approx([0.3, -20.0], abs=0.06)


def test_search_does_not_stop_early_on_a_flat_cost() -> None:
    class Flat(Valley):
        def residuals(self, x: FloatArray) -> FloatArray:
            return np.array([1.0])

    assert run(Flat())["generation"].max() == GENERATIONS


def test_best_is_the_first_of_equal_costs() -> None:
    history = pd.DataFrame({"cost": [3.0, 1.0, 1.0], "a": [0.1, 0.2, 0.3], "b": [1.0, 2.0, 3.0]})
    cost, x = best_of(history, Valley())
    assert cost == 1.0
    assert x.tolist() == [0.2, 2.0]


def test_convergence_is_the_running_best_at_the_end_of_each_generation() -> None:
    history = pd.DataFrame(
        {
            "call": [1, 2, 3, 4, 5, 6],
            "generation": [1, 1, 2, 2, 3, 3],
            "cost": [5.0, 4.0, 6.0, 3.0, 9.0, 8.0],
        }
    )
    assert convergence(history).to_dict("list") == {
        "generation": [1, 2, 3],
        "calls": [2, 4, 6],
        "best_cost": [4.0, 3.0, 3.0],
    }


def test_convergence_of_a_search_ends_at_its_best() -> None:
    problem: Any = Valley()
    history = run(problem)
    frame = convergence(history)
    assert frame["best_cost"].is_monotonic_decreasing
    assert frame["best_cost"].iloc[-1] == best_of(history, problem)[0]
    assert frame["calls"].iloc[-1] == len(history)


def test_failed_run_never_wins() -> None:
    problem: Any = Valley(fails=lambda x: bool(x[0] < 0.5))
    history = run(problem)
    failed = history["status"] == Status.TOO_MANY_STEPS
    assert failed.any()
    assert not failed.all()
    assert np.all(history.loc[failed, "cost"] == FAILED_COST)
    cost, x = best_of(history, problem)
    assert cost < FAILED_COST
    assert x[0] >= 0.5


def test_search_goes_on_where_every_run_fails() -> None:
    problem: Any = Valley(fails=lambda x: True)
    assert best_of(run(problem), problem)[0] == FAILED_COST


def test_progress_is_told_once_for_each_generation() -> None:
    told: list[tuple[int, int, float]] = []
    problem: Any = Valley()
    history = search(problem, 1, GENERATIONS, COMPLEXES, lambda *so_far: told.append(so_far))
    assert [generation for generation, _, _ in told] == [2, 3, 4, 5]
    frame = convergence(history).set_index("generation")
    for generation, calls, best in told:
        assert calls == frame["calls"][generation - 1]
        assert best == frame["best_cost"][generation - 1]


def test_search_prints_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    run(Valley())
    assert capsys.readouterr().out == ""


def test_seed_differs_with_every_part_of_the_identity() -> None:
    seeds = {
        seed_for(seed, cost, repetition)
        for seed in (0, 1, 11)
        for cost in ("RMSE", "RANGE", "kinetics")
        for repetition in (0, 1, 11)
    }
    assert len(seeds) == 27
    assert all(0 <= seed < 2**30 for seed in seeds)


def test_seed_of_an_identity_stays_the_same_for_ever() -> None:
    # Results that were published name their seeds: the function must not change.
    assert seed_for(2020, "RMSE", 3) == 983339810


# --- least squares --------------------------------------------------------------------------


def test_multistart_finds_the_optimum() -> None:
    starts = multistart(Valley(), 3, 1)
    assert len(starts) == 3
    for start in starts:
        assert start.values == pytest.approx([0.3, -20.0], abs=1e-4)
        assert start.cost == pytest.approx(0.0, abs=1e-6)
        assert start.at_bound == ()


def test_multistart_names_the_parameters_at_their_limits() -> None:
    start = multistart(Valley(optimum=(2.0, -20.0)), 1, 1)[0]
    assert start.at_bound == ("a",)
    assert start.values == pytest.approx([1.0, -20.0], abs=1e-2)
    start = multistart(Valley(optimum=(2.0, -60.0)), 1, 1)[0]
    assert start.at_bound == ("a", "b")


def test_multistart_is_sorted_by_cost_where_starts_end_apart() -> None:
    class TwoHoles(Valley):
        def residuals(self, x: FloatArray) -> FloatArray:
            a = x[0] - 0.5
            return np.array([(a**2 - 0.09) * 10, 0.5 * (a - 0.3), (x[1] + 20.0) / 60.0])

    costs = [s.cost for s in multistart(TwoHoles(), 8, 1)]
    assert costs == sorted(costs)
    assert costs[-1] > costs[0] + 0.1
    assert costs[0] == pytest.approx(0.0, abs=1e-5)


def test_multistart_draws_by_its_seed_alone() -> None:
    def asked(seed: int) -> list[list[float]]:
        problem = Watched()
        multistart(problem, 2, seed)
        return np.array(problem.asked).tolist()

    first = asked(1)
    np.random.seed(5)  # noqa: NPY002
    assert asked(1) == first
    assert asked(2) != first


def test_multistart_stays_inside_the_limits_and_counts_its_calls() -> None:
    problem = Watched(optimum=(1.0, -50.0))
    start = multistart(problem, 1, 1)[0]
    assert start.calls == len(problem.asked)
    assert np.all(np.array(problem.asked) >= problem.lower)
    assert np.all(np.array(problem.asked) <= problem.upper)


# --- CMA-ES ---------------------------------------------------------------------------------


def test_cmaes_finds_the_optimum_from_every_start() -> None:
    starts = cmaes.minimise(Valley(), 3, 1, 2000)
    assert len(starts) == 3
    assert [s.cost for s in starts] == sorted(s.cost for s in starts)
    for start in starts:
        assert start.values == pytest.approx([0.3, -20.0], rel=1e-3)
        assert start.cost < 1e-3
        assert start.at_bound == ()


def test_cmaes_draws_from_its_seed_alone() -> None:
    def ends(seed: int) -> list[list[float]]:
        return [s.values.tolist() for s in cmaes.minimise(Valley(), 2, seed, 60)]

    first = ends(1)
    np.random.seed(5)  # noqa: NPY002
    assert ends(1) == first
    assert ends(2) != first
    np.random.seed(5)  # noqa: NPY002
    before = np.random.get_state()[1].tolist()  # noqa: NPY002
    ends(1)
    assert np.random.get_state()[1].tolist() == before  # noqa: NPY002


def test_cmaes_counts_its_calls_stays_within_the_limits_and_keeps_to_its_budget() -> None:
    problem = Valley(optimum=(1.3, -50.0))
    start = cmaes.minimise(problem, 1, 1, 100)[0]
    asked = np.array(problem.asked)
    assert start.calls == len(asked)
    assert 100 <= len(asked) < 120  # the last generation is not cut
    assert np.all(asked >= problem.lower)
    assert np.all(asked <= problem.upper)
    assert start.cost == min(np.linalg.norm(problem.residuals(x)) for x in asked)


def test_cmaes_names_the_parameters_at_their_limits() -> None:
    start = cmaes.minimise(Valley(optimum=(1.3, -20.0)), 1, 1, 2000)[0]
    assert start.at_bound == ("a",)
    assert start.values == pytest.approx([1.0, -20.0], rel=1e-3)


def test_cmaes_goes_on_where_runs_fail() -> None:
    problem = Valley(fails=lambda x: x[0] > 0.5)
    start = cmaes.minimise(problem, 1, 1, 2000)[0]
    assert start.values == pytest.approx([0.3, -20.0], rel=1e-3)


def test_cmaes_depends_on_ranks_of_the_cost_alone() -> None:
    class Small(Valley):
        def residuals(self, x: FloatArray) -> FloatArray:
            return 1e-9 * super().residuals(x)

    large, small = (cmaes.minimise(p, 1, 1, 2000)[0] for p in (Valley(), Small()))
    assert small.calls == large.calls
    assert np.array_equal(small.values, large.values)


# --- the problem ----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def study() -> Study:
    study = read_study(CONFIG / "smoke.yaml")
    return study.model_copy(update={"accuracy": study.accuracy.model_copy(update={"cells": 10})})


TRUTH = {
    "T_p": 605.0,
    "E_p": 190e3,
    "rho": 1190.0,
    "k": 0.2,
    "cp": 2100.0,
    "eps": 0.9,
    "dh": 800e3,
}
ESTIMATE = ("rho", "k", "cp", "eps", "dh")
AT_TRUTH = np.array([TRUTH[n] for n in ESTIMATE])


def slab(study: Study) -> dict[tuple[str, str], pd.DataFrame]:
    """Return what the problem's own model gives at the truth, as if it were measured."""
    time = np.arange(5.0, 300.0, 10.0)
    requests = {"mlr": Request(time, 5.0), "back_temperature": Request(time)}
    signals = simulate_gasification(
        study.experiments["slab_60"],
        study.material,
        TRUTH,
        requests,
        study.accuracy,
    ).signals
    mlr = {"time_s": time, "mlr_kg_m2_s": signals["mlr"]}
    back = {"time_s": time, "back_temperature_K": signals["back_temperature"]}
    return {
        ("slab_60", "mlr"): pd.DataFrame(mlr),
        ("slab_60", "back_temperature"): pd.DataFrame(back),
    }


def term(**options: Any) -> TermSpec:
    return TermSpec(**{"experiment": "slab_60", "signal": "mlr", "kind": "RMSE", **options})


def posed(study: Study, *terms: TermSpec) -> Problem:
    return make_problem(study, ESTIMATE, terms, slab(study), study.material, TRUTH)


def test_problem_has_the_limits_in_si_units(study: Study) -> None:
    problem = posed(study, term())
    assert problem.names == ESTIMATE
    assert problem.lower.tolist() == [900.0, 0.1, 1000.0, 0.5, 250e3]
    assert problem.upper.tolist() == [1500.0, 0.4, 3000.0, 0.99, 1500e3]


def test_estimated_parameters_are_not_fixed(study: Study) -> None:
    assert posed(study, term()).fixed == {"T_p": 605.0, "E_p": 190e3}


def test_cost_of_the_model_s_own_curve_is_zero(study: Study) -> None:
    problem = posed(study, term(), term(signal="back_temperature"))
    result = problem.evaluate(AT_TRUTH)
    assert result == Evaluation(0.0, (0.0, 0.0), Status.OK)
    assert np.all(problem.residuals(AT_TRUTH) == 0.0)


def test_cost_away_from_the_truth_is_the_rmse_worked_out_here(study: Study) -> None:
    problem = posed(study, term())
    x = AT_TRUTH * [1.1, 1.0, 1.0, 1.0, 1.0]
    frame = slab(study)["slab_60", "mlr"]
    curves = simulate_gasification(
        study.experiments["slab_60"],
        study.material,
        {**TRUTH, "rho": TRUTH["rho"] * 1.1},
        {"mlr": Request(frame["time_s"].to_numpy(), 5.0)},
        study.accuracy,
    )
    expected = np.sqrt(np.mean((curves.signals["mlr"] - frame["mlr_kg_m2_s"]) ** 2))
    assert expected > 1e-4
    assert problem.evaluate(x).cost == pytest.approx(expected, rel=1e-12)


def test_two_terms_on_one_signal_keep_their_own_points_and_window(study: Study) -> None:
    whole = term(points=7)
    part = term(window_s=(50.0, 120.0))
    both = posed(study, whole, part)
    assert len(both.runs) == 1
    x = AT_TRUTH * 1.02
    models = both.simulate(x)[1]
    assert [m.size for m in models] == [7, 7]
    assert both.cost.terms[1][1].target.time_s.tolist() == [55, 65, 75, 85, 95, 105, 115]
    alone = [posed(study, t).evaluate(x).cost for t in (whole, part)]
    together = both.evaluate(x)
    # Alone, the window ends the run earlier: its last time steps differ a little.
    assert together.parts == pytest.approx(alone, rel=1e-3)


def test_weights_multiply_the_parts(study: Study) -> None:
    x = AT_TRUTH * 1.02
    plain = posed(study, term()).evaluate(x).cost
    weighted = posed(study, term(weight=3.0), term(weight=0.5), term(weight=0.0)).evaluate(x)
    assert weighted.parts == pytest.approx((3.0 * plain, 0.5 * plain, 0.0), rel=1e-12)
    assert weighted.cost == pytest.approx(3.5 * plain, rel=1e-12)


def test_norm_of_the_residuals_of_one_term_is_its_cost(study: Study) -> None:
    problem = posed(study, term(weight=2.0, normalisation="mean"))
    x = AT_TRUTH * 1.02
    norm = float(np.linalg.norm(problem.residuals(x)))
    assert norm == pytest.approx(problem.evaluate(x).cost, rel=1e-12)


def test_unfinished_run_costs_more_than_any_finished_one(study: Study) -> None:
    hasty = study.model_copy(
        update={
            "accuracy": study.accuracy.model_copy(update={"most_steps": 100, "tolerance": 1e-6})
        }
    )
    frames = slab(study)
    problem = make_problem(hasty, ESTIMATE, [term()], frames, study.material, TRUTH)
    result = problem.evaluate(AT_TRUTH)
    assert result == Evaluation(FAILED_COST, (FAILED_COST,), Status.TOO_MANY_STEPS)
    residuals = problem.residuals(AT_TRUTH)
    assert residuals.shape == (len(frames["slab_60", "mlr"]),)
    assert np.linalg.norm(residuals) >= np.sqrt(FAILED_COST)


def test_unfinished_run_has_as_many_residuals_as_a_finished_one(study: Study) -> None:
    # NRSE compares single points: one residual, however long the curve.
    terms = [term(kind="NRSE", options={"time_s": 60.0}), term(weight=0.0), term()]
    finished = posed(study, *terms).residuals(AT_TRUTH)
    hasty = study.model_copy(
        update={
            "accuracy": study.accuracy.model_copy(update={"most_steps": 100, "tolerance": 1e-6})
        }
    )
    problem = make_problem(hasty, ESTIMATE, terms, slab(study), study.material, TRUTH)
    assert problem.residuals(AT_TRUTH).shape == finished.shape


def test_sets_evaluated_at_once_are_as_each_alone(study: Study) -> None:
    hasty = study.model_copy(
        update={"accuracy": study.accuracy.model_copy(update={"most_steps": 260})}
    )
    terms = [term(), term(signal="back_temperature", weight=1e-3)]
    problem = make_problem(hasty, ESTIMATE, terms, slab(study), study.material, TRUTH)
    draw = np.random.default_rng(12)
    X = problem.lower + (problem.upper - problem.lower) * draw.random((13, len(ESTIMATE)))
    X[4, 1] = 1e-4
    evaluations = problem.evaluate_all(X)
    assert evaluations == [problem.evaluate(x) for x in X]
    assert len({e.cost for e in evaluations}) == len(X)
    for found, x in zip(problem.residuals_all(X), X, strict=True):
        assert np.array_equal(found, problem.residuals(x))


def test_no_sets_have_no_costs(study: Study) -> None:
    assert posed(study, term()).evaluate_all(np.empty((0, len(ESTIMATE)))) == []


def test_cost_that_does_not_fit_its_target_is_refused(study: Study) -> None:
    with pytest.raises(CostError, match="window 5000 to 6000 s: 0 points lie inside"):
        posed(study, term(window_s=(5000.0, 6000.0)))


def test_target_has_the_uncertainty_where_one_is_known() -> None:
    frame = pd.DataFrame({"time_s": [0.0, 1.0], "mlr_kg_m2_s": [1.0, 2.0]})
    assert target_of(frame, known_quantities()["mlr"]).uncertainty is None
    frame["mlr_uncertainty_kg_m2_s"] = [0.1, 0.2]
    assert target_of(frame, known_quantities()["mlr"]).uncertainty.tolist() == [0.1, 0.2]


def tga(study: Study, how: str) -> Tga:
    experiment = study.experiments["tga_5K"].model_copy(update={"program": how})
    assert isinstance(experiment, Tga)
    return experiment


SLOW_START = pd.DataFrame(
    {"time_s": [10.0, 70.0, 130.0], "temperature_K": [400.0, 402.0, 409.0], "mass_fraction": 1.0}
)


def test_measured_program_follows_the_thermocouple(study: Study) -> None:
    times = np.array([10.0, 40.0, 130.0])
    assert programme(tga(study, "measured"), SLOW_START, times).tolist() == [400.0, 401.0, 409.0]


def test_nominal_program_rises_at_the_nominal_rate(study: Study) -> None:
    times = np.array([10.0, 40.0, 130.0])
    assert programme(tga(study, "nominal"), SLOW_START, times).tolist() == [400.0, 402.5, 410.0]


def test_request_for_tga_has_temperatures_and_for_a_slab_bins(study: Study) -> None:
    times = np.array([10.0, 70.0])
    asked = request(tga(study, "measured"), "mass_fraction", SLOW_START, times)
    assert asked.temperature_K is not None
    assert asked.temperature_K.tolist() == [400.0, 402.0]
    asked = KINDS["gasification"].request(study.experiments["slab_60"], "mlr", SLOW_START, times)
    assert (asked.average_s, asked.temperature_K) == (5.0, None)


def test_program_of_tga_changes_the_cost(study: Study) -> None:
    time = np.linspace(0.0, 3600.0, 60)
    temperature = 450.0 + 5.0 / 60.0 * time + 8.0 * np.sin(time / 600.0)
    curves = simulate_tga(
        tga(study, "measured"), study.material, TRUTH, Request(time, temperature_K=temperature)
    )
    frame = pd.DataFrame(
        {
            "time_s": time,
            "temperature_K": temperature,
            "mass_fraction": curves.signals["mass_fraction"],
        }
    )
    costs = {}
    for how in ("measured", "nominal"):
        own = study.model_copy(update={"experiments": {"tga_5K": tga(study, how)}})
        spec = term(experiment="tga_5K", signal="mass_fraction")
        problem = make_problem(
            own, ("T_p", "E_p"), [spec], {("tga_5K", "mass_fraction"): frame}, study.material, {}
        )
        costs[how] = problem.evaluate(np.array([605.0, 190e3])).cost
    assert costs["measured"] == pytest.approx(0.0, abs=1e-12)
    assert costs["nominal"] > 0.005
