"""New measurements: how far they separate models, and which of them is the best."""

from dataclasses import replace

import numpy as np
import pytest
from free_twins import MLR, SLABS, STEP, nothing, substance, twin

from pyrofit.diagnose.advise.candidate_experiments import ideas
from pyrofit.diagnose.advise.separation import next_experiments
from pyrofit.diagnose.base.descent import Fit
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.search.refit import look_at, with_effect
from pyrofit.estimate.derivatives import SECANT
from pyrofit.results.diagnosis_schema import OfExperiment
from pyrofit.simulate import simulate_tga
from pyrofit.solver.curves import Request

WITH_TGA = (*SLABS, ("tga_10K", "mass_fraction"))


def rivals(*effects: str) -> list[FittedModel]:
    """Fits of several effects to a truth whose conductivity falls."""
    trial = twin(substance("conductivity_W_mK", slope_1_K=-3e-4))
    return [with_effect(trial, look) for look in look_at(trial, effects)]


@pytest.fixture(scope="module")
def k_against_c() -> list[FittedModel]:
    return rivals("k_T", "c_T")


@pytest.fixture(scope="module")
def found(k_against_c: list[FittedModel]) -> dict[str, OfExperiment]:
    return {design.design: design for design in next_experiments(k_against_c)}


def test_insulated_back_or_thicker_sample_tells_conductivity_from_heat_capacity(
    found: dict[str, OfExperiment],
) -> None:
    best = next(iter(found.values()))
    assert "insulated_back" in best.design or "thickness" in best.design
    assert best.separation_sd > 2.0
    again = found["capa_25_insulated_back+back_temperature"]
    assert again.words == (
        "gasification at 25 kW/m², the back insulated, with the back temperature"
    )


def test_designs_are_sorted_and_name_their_pair(found: dict[str, OfExperiment]) -> None:
    sizes = [design.separation_sd for design in found.values()]
    assert sizes == sorted(sizes, reverse=True)
    assert min(sizes) >= 0.0
    assert all(list(design.pairs) == ["k_T | c_T"] for design in found.values())
    assert all(d.pairs["k_T | c_T"] == d.separation_sd for d in found.values())


def test_back_temperature_never_takes_separation_away(found: dict[str, OfExperiment]) -> None:
    with_back = [name for name in found if name.endswith("+back_temperature")]
    assert len(with_back) > 5
    for name in with_back:
        alone = found[name.removesuffix("+back_temperature")]
        assert found[name].separation_sd >= alone.separation_sd - 1e-9


def test_equal_models_are_not_separated(k_against_c: list[FittedModel]) -> None:
    one = k_against_c[0]
    assert {d.separation_sd for d in next_experiments([one, one])} == {0.0}


def test_one_model_needs_no_experiment(k_against_c: list[FittedModel]) -> None:
    assert next_experiments(k_against_c[:1]) == []


def test_separation_of_three_is_that_of_the_nearest_two(k_against_c: list[FittedModel]) -> None:
    three = next_experiments([*k_against_c, twin(nothing)])
    assert all(set(d.pairs) == {"k_T | c_T", "k_T | base", "c_T | base"} for d in three)
    assert all(d.separation_sd == min(d.pairs.values()) for d in three)


def test_uncertain_parameters_separate_less(k_against_c: list[FittedModel]) -> None:
    def sure(trial: FittedModel, times: float) -> FittedModel:
        fit = trial.fit
        return replace(trial, fit=Fit(fit.chi2, fit.x, fit.residuals, times * fit.jacobian))

    def total(times: float) -> float:
        found = next_experiments([sure(trial, times) for trial in k_against_c])
        return sum(design.separation_sd for design in found)

    assert total(0.1) < 0.8 * total(1.0)
    assert total(10.0) > 1.2 * total(1.0)


def test_separation_by_a_tga_is_the_formula_written_out() -> None:
    trial = twin(nothing, WITH_TGA)
    moved = trial.fit.x.copy()
    moved[trial.model.names.index("E_B")] += 0.05
    other = replace(trial, fit=replace(trial.fit, x=moved))
    design = next(d for d in next_experiments([trial, other]) if d.design == "tga_30_K_min")
    problem = trial.model.likelihood.problem
    run = problem.runs["tga_10K"]
    slow = run.requests["mass_fraction"]
    assert slow.temperature_K is not None
    T = np.linspace(slow.temperature_K[0], slow.temperature_K[-1], slow.time_s.size)
    request = Request((T - T[0]) / 0.5, temperature_K=T)

    def curve(x: np.ndarray) -> np.ndarray:
        values = problem.values(trial.model.likelihood.values(x))
        return simulate_tga(run.experiment, problem.material, values, request).signals[  # type: ignore[arg-type]
            "mass_fraction"
        ]

    sd = np.hypot(5e-3, 0.5 * np.gradient(curve(trial.fit.x), request.time_s))
    D = (curve(moved) - curve(trial.fit.x)) / sd
    S = np.eye(D.size)
    C = np.linalg.inv(trial.fit.jacobian.T @ trial.fit.jacobian + 12.0 * np.eye(moved.size))
    for x in (trial.fit.x, moved):
        by = [SECANT.step if xi < 0.5 else -SECANT.step for xi in x]
        steps = np.diag(by)
        J = np.column_stack([(curve(x + s) - curve(x)) / b for s, b in zip(steps, by, strict=True)])
        J = J / sd[:, None]
        S += J @ C @ J.T
    assert design.separation_sd == pytest.approx(np.sqrt(D @ np.linalg.solve(S, D)), rel=1e-6)
    assert design.separation_sd > 0.1


def test_ideas_cover_fluxes_thicknesses_backs_and_rates() -> None:
    problem = twin(STEP, WITH_TGA).model.likelihood.problem
    names = [idea.choices[0][0] for idea in ideas(problem, problem)]
    assert names == [
        "flux_15_kW_m2",
        "flux_40_kW_m2",
        "flux_90_kW_m2",
        "flux_30_kW_m2",
        "capa_25_half_thickness",
        "capa_25_double_thickness",
        "capa_25_insulated_back",
        "capa_60_half_thickness",
        "capa_60_double_thickness",
        "capa_60_insulated_back",
        "tga_3.33_K_min",
        "tga_30_K_min",
    ]


def test_back_temperature_that_was_not_calibrated_is_an_idea() -> None:
    problem = twin(nothing, MLR).model.likelihood.problem
    choices = [choice for idea in ideas(problem, problem) for choice in idea.choices]
    words = {name: (words, signals) for name, words, signals in choices}
    assert words["capa_25+back_temperature"] == (
        "gasification at 25 kW/m² again, with the back temperature",
        ("mlr", "back_temperature"),
    )


def test_what_is_held_out_is_measured_and_no_idea() -> None:
    everything = twin(nothing, WITH_TGA).model.likelihood.problem
    fitted = {"capa_25": everything.runs["capa_25"]}
    names = [choice[0] for idea in ideas(everything, everything) for choice in idea.choices]
    partly = replace(everything, runs=fitted)
    left = [choice[0] for idea in ideas(partly, everything) for choice in idea.choices]
    assert left
    assert set(left) < set(names)
    assert "flux_60_kW_m2" in [i.choices[0][0] for i in ideas(partly, partly)]
    bare = replace(fitted["capa_25"], requests={"mlr": fitted["capa_25"].requests["mlr"]})
    partly = replace(everything, runs={"capa_25": bare})
    again = "capa_25+back_temperature"
    assert again in [i.choices[0][0] for i in ideas(partly, partly)]
    assert again not in [i.choices[0][0] for i in ideas(partly, everything)]


def test_changed_experiments_are_what_they_are_called() -> None:
    problem = twin(nothing, WITH_TGA).model.likelihood.problem
    made = {
        idea.choices[0][0]: idea.change(problem.runs[idea.like].experiment)
        for idea in ideas(problem, problem)
    }
    assert made["flux_90_kW_m2"].front.flux_W_m2 == 9e4
    assert made["flux_90_kW_m2"].front.gas_temperature_K == 365.0
    assert made["flux_15_kW_m2"].front.gas_temperature_K == 330.0
    assert made["capa_25_half_thickness"].sample.layers[0].thickness_m == 0.0029
    assert made["capa_25_insulated_back"].back.h_W_m2K == 0.0
    assert made["capa_25_insulated_back"].back.emissivity == 0.0
    assert made["tga_30_K_min"].heating_rate_K_min == 30.0
