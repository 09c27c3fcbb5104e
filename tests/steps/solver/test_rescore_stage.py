"""Stored calls of a small study scored again: values, sample, files, messages."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import yaml
from stage_studies import given, searched_by_hand, study_with

from pyrofit.cli import main
from pyrofit.config import Study
from pyrofit.estimate.pose import of_imp
from pyrofit.estimate.problem import make_problem
from pyrofit.results import kinetics, recorded, searches
from pyrofit.results.files import Results, read_csv
from pyrofit.results.step import write_options
from pyrofit.stages import fit, identify, measurements
from pyrofit.stages.imp_likelihood import imp_likelihood
from pyrofit.steps.rescore import record as rescored
from pyrofit.steps.rescore.compute import run
from pyrofit.steps.rescore.page import PAGE
from pyrofit.steps.rescore.sentences import sentences

SIXTY = {"rescore": {"sets": 60}}


@pytest.fixture(scope="module")
def study() -> Study:
    return study_with(steps=SIXTY)


@pytest.fixture(scope="module")
def results(study: Study, tmp_path_factory: pytest.TempPathFactory) -> Results:
    """Searches of a small budget, their calls scored again, drawn."""
    results = Results(tmp_path_factory.mktemp("rescore") / "smoke")
    measurements.prepare(study, results)
    fit.fit_kinetics(study, results)
    identify.identify_kinetics(study, results)
    for cost in study.imp.costs:
        fit.repeat(study, results, cost, range(study.imp.repetitions))
    searched_by_hand(study, results, study.true_values())
    run(study, results, print, 1)
    write_options(study, results, "rescore")
    PAGE.write(study, results)
    return results


def copied(results: Results, to: Path) -> Results:
    shutil.copytree(results.root, to)
    return Results(to)


def by_name(study: Study, results: Results) -> dict[str, rescored.OfMeasure]:
    return {measure.name: measure for measure in rescored.read(study, results).measures}


def test_cost_of_the_study_has_its_stored_value_again(study: Study, results: Results) -> None:
    found = rescored.read(study, results)
    assert (found.sampled, found.histories, found.unfinished) == (60, 6, 0)
    assert found.drift < 1e-12


def test_lowest_stored_call_of_every_search_is_scored(study: Study, results: Results) -> None:
    sets = read_csv(results.of_step("rescore", rescored.SETS))
    for (cost, number), group in sets.groupby(["cost_function", "repetition"]):
        history = searches.history(study, results, str(cost), int(str(number)))
        assert group["cost"].min() == history["cost"].min()
        assert len(group) == 10
    stored = sets.groupby("cost_function")["cost"].min()
    for cost, lowest in stored.items():
        assert by_name(study, results)[str(cost)].value <= lowest


def test_scores_are_those_of_each_cost_alone(study: Study, results: Results) -> None:
    sets = read_csv(results.of_step("rescore", rescored.SETS))
    scores = read_csv(results.of_step("rescore", rescored.SCORES)).pivot(
        index="set", columns="cost", values="value"
    )
    row = sets.iloc[7]
    values = row[list(study.imp.estimate)].to_numpy(float)
    series = recorded.load(study, results)
    material, fixed = study.material, kinetics.fixed_for_imp(study, results)
    channels = study.imp.channels
    problem = make_problem(study, study.imp.estimate, channels, series, material, fixed)
    _, (model,) = problem.simulate(values)
    measured = problem.cost.terms[0][1].target.value
    mine = scores.loc[row["set"]]
    rms = float(np.sqrt(np.mean((model - measured) ** 2)))
    assert mine["RMSE_none"] == pytest.approx(rms, rel=1e-12)
    assert mine["NRMS"] == pytest.approx(rms / np.ptp(measured), rel=1e-12)
    share = np.abs(measured) / (np.abs(model - measured) + 0.1 * np.abs(measured))
    assert mine["GPYRO"] == pytest.approx(1.0 - 0.01 * np.mean(share**2), rel=1e-12)
    likelihood = imp_likelihood(study, results, of_imp(study))
    chi2 = likelihood.chi2(likelihood.scaled(values))
    assert mine["chi2"] == pytest.approx(chi2, rel=1e-9)


def test_temperature_counts_from_the_initial_one_in_gpyros_objective(study: Study) -> None:
    from pyrofit.estimate.measures import measures_of

    series = measurements.computed(study)
    chosen, _ = measures_of(study, series, ["GPYRO_all"])
    options = {term.signal: term.options for term in chosen[0].terms}
    assert options == {"mlr": {}, "back_temperature": {"reference": 295.0}}


def test_costs_that_differ_by_a_factor_rank_in_the_same_order(
    study: Study, results: Results
) -> None:
    same = next(group for group in rescored.read(study, results).same if "RMSE" in group)
    assert {"RMSE_none", "RMSE_mean", "RMSE_iqr", "NRMS"} < set(same)
    assert "rank all sets in the same order" in " ".join(sentences(study, results))


def test_valleys_are_fractions_of_the_limits_about_the_best_set(
    study: Study, results: Results
) -> None:
    for measure in rescored.read(study, results).measures:
        for name, at in measure.valley.items():
            assert 0.0 <= at.low <= at.best <= at.high <= 1.0
            low, high = study.parameters[name].bounds_si
            assert low + at.best * (high - low) == pytest.approx(measure.parameters[name])


def test_two_processes_leave_the_same_bytes(
    study: Study, results: Results, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pyrofit.stages.scorer.AT_ONCE", 16)
    some = study_with(steps={"rescore": {"sets": 60, "costs": ["RMSE", "chi2"]}})
    found = {}
    for cores in (1, 2):
        there = copied(results, tmp_path / str(cores))
        run(some, there, print, cores)
        names = (rescored.FILE, rescored.SETS, rescored.SCORES, rescored.CORRELATION)
        found[cores] = [there.of_step("rescore", name).read_bytes() for name in names]
    assert found[1] == found[2]


def test_page_has_figures_numbers_and_table(study: Study, results: Results) -> None:
    shown = PAGE.section(study, results)
    assert [type(part).__name__ for part in shown.parts] == ["Picture"] * 3 + ["Passage"]
    assert shown.said[0].startswith("60 of ")
    for name in ("agreement", "agreement_best", "regret", "valleys"):
        assert results.of_step("rescore", f"{name}.png").stat().st_size > 0
    text = results.of_step("rescore", "table_rank_correlation.md").read_text()
    assert text.startswith("# Rank correlation of the costs over the stored sets (synthetic data)")


def command(results: Results, folder: Path, *options: str) -> list[str]:
    path = folder / "mine.yaml"
    if not path.exists():
        path.write_text(yaml.safe_dump(given(steps=SIXTY), sort_keys=False))
    return ["rescore", str(path), "--results", str(results.root), *options]


def test_command_takes_costs_and_all_sets(
    results: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    there = copied(results, tmp_path / "there")
    assert main(command(there, tmp_path, "--costs", "RMSE", "GPYRO", "--sets", "all")) == 0
    said = capsys.readouterr()
    by_hand = Results(there.root, by_hand="rescore")
    content = json.loads(by_hand.of_step("rescore", rescored.FILE).read_text())
    assert [measure["name"] for measure in content["measures"]] == ["RMSE", "GPYRO"]
    assert content["sampled"] == content["stored"] > 60
    assert f"scoring {content['stored']} of {content['stored']} stored sets" in said.err
    assert "rank correlation" in said.out


def test_unknown_cost_is_told_with_the_file_and_the_known_ones(
    results: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(command(results, tmp_path, "--costs", "GPYR")) == 2
    said = capsys.readouterr().err
    assert f"{tmp_path / 'mine.yaml'}: unknown cost 'GPYR'. Did you mean 'GPYRO'?" in said


def test_cost_that_cannot_be_computed_is_told(
    results: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    there = copied(results, tmp_path / "there")
    path = there.measurement("slab_25", "mlr")
    frame = read_csv(path).assign(mlr_kg_m2_s=0.0)
    path.write_text(frame.to_csv(index=False))
    assert main(command(there, tmp_path, "--costs", "NRSE")) == 2
    said = capsys.readouterr().err
    assert "cost 'NRSE' cannot be computed for slab_25.mlr: NRSE: the target is 0" in said


def test_study_that_has_not_run_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    nowhere = Results(tmp_path / "nowhere")
    assert main(command(nowhere, tmp_path)) == 2
    said = capsys.readouterr().err
    assert f"{nowhere.repetition('RMSE', 0, '.json')}: this search has not run" in said
    assert "Run the study first: snakemake --cores 2 --configfile" in said


def test_study_with_other_limits_than_its_searches_is_refused(
    results: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    changed = given(steps=SIXTY, parameters__k={"unit": "W/(m K)", "lower": 0.1, "upper": 0.7})
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(changed, sort_keys=False))
    assert main(command(results, tmp_path)) == 2
    said = capsys.readouterr().err
    assert f"{results.repetition('RMSE', 0, '.json')}: this search belongs to another" in said
    assert "or name the study file that it ran with" in said


@pytest.mark.parametrize("count", ["none", "0", "1", "-5", "2.5"])
def test_number_of_sets_is_checked(
    count: str, results: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(command(results, tmp_path, f"--sets={count}")) == 2
    said = capsys.readouterr().err
    assert re.search(rf"--sets: '{count}' (must be at least 2|is not a whole number)", said)
