"""A known truth is found again from noise-free data of an independent solver."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from pyrofit.config import Study, as_study
from pyrofit.estimate.history import best_of, convergence
from pyrofit.estimate.least_squares import multistart
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.estimate.sceua import search
from pyrofit.stages.measurements import computed

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
TRUTH = {"rho": 1190.0, "k": 0.2, "cp": 2100.0, "eps": 0.9, "dh": 800e3}
KINETICS = {"T_p": 605.0, "E_p": 190e3}


def study() -> Study:
    """Return the smoke study without noise, fitted on 25 cells to the reference solver."""
    given = yaml.safe_load(SMOKE.read_text(encoding="utf-8"))
    for experiment in given["experiments"].values():
        for signal in experiment["signals"].values():
            signal["noise"] = 0.0
    given["accuracy"] = {"cells": 25, "tolerance": 1e-3}
    return as_study(given, "smoke.yaml")


@pytest.fixture(scope="module")
def known() -> tuple[Study, dict[tuple[str, str], Any]]:
    described = study()
    return described, computed(described)


def posed(known: Any, estimate: tuple[str, ...], *signals: str) -> Problem:
    """Return the problem of estimating some parameters, all others known, from slab_60."""
    described, measured = known
    spec = described.imp.costs["RMSE"][0]
    terms = [spec.model_copy(update={"experiment": "slab_60", "signal": s}) for s in signals]
    fixed = {**KINETICS, **TRUTH}
    return make_problem(described, estimate, terms, measured, described.material, fixed)


def relative_error(problem: Problem, values: Any) -> dict[str, float]:
    truth = {**KINETICS, **TRUTH}
    pairs = zip(problem.names, values.tolist(), strict=True)
    return {name: abs(found / truth[name] - 1.0) for name, found in pairs}


def test_least_squares_recovers_all_properties_from_rate_and_back_temperature(known: Any) -> None:
    problem = posed(known, tuple(TRUTH), "mlr", "back_temperature")
    # Three of four starts end there, the others at cp on its limit.
    best = multistart(problem, 4, 1)[0]
    error = relative_error(problem, best.values)
    assert error.pop("rho") < 1e-4  # the released mass alone determines it
    assert max(error.values()) < 5e-3, error
    assert best.at_bound == ()


def test_sce_ua_recovers_density_and_heat_of_reaction_from_the_rate(known: Any) -> None:
    problem = posed(known, ("rho", "dh"), "mlr")
    history = search(problem, 1, 8)
    cost, x = best_of(history, problem)
    error = relative_error(problem, x)
    assert max(error.values()) < 5e-3, error
    assert cost < 0.05 * convergence(history)["best_cost"].iloc[0]


def test_fit_is_no_worse_than_the_truth(known: Any) -> None:
    problem = posed(known, ("rho", "dh"), "mlr")
    truth = np.array([TRUTH["rho"], TRUTH["dh"]])
    assert multistart(problem, 1, 1)[0].cost <= problem.evaluate(truth).cost


def test_tga_recovers_reference_temperature_and_activation_energy(known: Any) -> None:
    described, measured = known
    problem = make_problem(
        described, tuple(KINETICS), described.kinetics.cost, measured, described.material, {}
    )
    searched = relative_error(problem, best_of(search(problem, 1, 10), problem)[1])
    assert searched["T_p"] < 1e-4
    assert searched["E_p"] < 5e-4
    polished = relative_error(problem, multistart(problem, 1, 1)[0].values)
    assert max(polished.values()) < 1e-6, polished
