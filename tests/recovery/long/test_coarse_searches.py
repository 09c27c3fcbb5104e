"""Searches take coarser runs as long as no signal shows the difference."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from pyrofit.config import as_study
from pyrofit.estimate.coarse import OF_NOISE, are_close, for_search, point_noise
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.measurements import computed

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"
TRUTH = {"T_p": 605.0, "E_p": 190e3, "rho": 1190.0, "k": 0.2, "cp": 2100.0, "eps": 0.9, "dh": 800e3}


def posed(noise: float) -> Problem:
    """Return a problem of the rate at 25 kW/m2, with white noise [kg/(m2 s)] in the measurement."""
    given = yaml.safe_load(SMOKE.read_text(encoding="utf-8"))
    for experiment in given["experiments"].values():
        for signal in experiment["signals"].values():
            signal["noise"] = 0.0
    given["experiments"]["slab_25"]["signals"]["mlr"]["noise"] = noise
    study = as_study(given, "smoke.yaml")
    measured = computed(study)
    estimate = study.imp.estimate
    terms = study.imp.costs["RMSE"]
    return make_problem(study, estimate, terms, measured, study.material, TRUTH)


@pytest.fixture(scope="module")
def noisy() -> Problem:
    return posed(2e-4)


def truth(problem: Problem) -> FloatArray:
    return np.array([[TRUTH[name] for name in problem.names]])


def test_search_takes_coarser_runs_below_the_noise(noisy: Problem) -> None:
    assert for_search(noisy).accuracy == noisy.accuracy.coarsened()


def test_search_keeps_its_runs_where_coarser_ones_differ_by_the_noise() -> None:
    exact = posed(0.0)
    coarse = replace(exact, accuracy=exact.accuracy.coarsened())
    assert are_close(coarse, exact, truth(exact)) == [False]


def test_the_error_of_coarser_runs_is_below_the_stated_share_of_the_noise(noisy: Problem) -> None:
    coarse = for_search(noisy)
    (_, (rough,)), (_, (fine,)) = (p.simulate(truth(noisy)[0]) for p in (coarse, noisy.refined()))
    assert np.sqrt(np.mean((rough - fine) ** 2)) < 1.2 * OF_NOISE * 2e-4


def test_a_run_that_fails_only_if_coarse_is_not_close(noisy: Problem) -> None:
    few = replace(noisy, accuracy=noisy.accuracy.model_copy(update={"most_steps": 100}))
    assert are_close(few, noisy, truth(noisy)) == [False]
    assert are_close(few, few, truth(noisy)) == [True]


@pytest.mark.parametrize("slope", [0.0, 1.0])
def test_noise_of_points_is_that_of_white_noise_on_a_line(slope: float) -> None:
    t = np.arange(4000.0)
    noise = 0.5 * np.random.default_rng(1).standard_normal(t.size)
    assert point_noise(slope * t + noise) == pytest.approx(0.5, rel=0.05)
