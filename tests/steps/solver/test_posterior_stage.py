"""The posterior of a small study: files, bands, messages."""

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from made_records import noise_of
from stage_studies import given, searched_by_hand, study_with

from pyrofit.cli import main
from pyrofit.config import Study
from pyrofit.estimate import ensembles
from pyrofit.estimate.pose import of_imp
from pyrofit.results.files import Results, read_csv, write_csv, write_json
from pyrofit.results.identification import StageNoise, write_noise
from pyrofit.results.step import write_options
from pyrofit.stages import fit, identify, measurements
from pyrofit.stages.imp_likelihood import imp_likelihood
from pyrofit.steps.posterior import record as posterior
from pyrofit.steps.posterior.compute import run
from pyrofit.steps.posterior.page import PAGE
from pyrofit.steps.posterior.sentences import sentences
from pyrofit_exchange.sets import parameter_set

STEPS, SETS = 24, 12
CHANGES: dict[str, Any] = {
    "imp__identification": {"slab_60": ["mlr"]},
    "known": {"k": {"value": 0.2, "sd": 0.004}},
    "steps": {"posterior": {"steps": STEPS, "sets": SETS}},
}


@pytest.fixture(scope="module")
def study() -> Study:
    return study_with(**CHANGES)


@pytest.fixture(scope="module", autouse=True)
def few_walkers() -> Any:
    patch = pytest.MonkeyPatch()
    patch.setattr(ensembles, "LEAST_WALKERS", 12)
    patch.setattr(ensembles, "PER_PARAMETER", 2)
    yield
    patch.undo()


@pytest.fixture(scope="module")
def identified(study: Study, tmp_path_factory: pytest.TempPathFactory) -> Results:
    """The truth stands for what the step `identify` finds."""
    results = Results(tmp_path_factory.mktemp("posterior") / "smoke")
    measurements.prepare(study, results)
    fit.fit_kinetics(study, results)
    identify.identify_kinetics(study, results)
    truth = np.array([study.true_values()[name] for name in study.imp.estimate])
    searched_by_hand(study, results, dict(zip(study.imp.estimate, truth.tolist(), strict=True)))
    likelihood = imp_likelihood(study, results, of_imp(study))
    residuals = likelihood.residuals(likelihood.scaled(truth))[: sum(likelihood.points)]
    numbers = dict.fromkeys(
        ("sd", "apparatus_sd", "low", "high", "width", "noise_low", "noise_high", "noise_width"),
        0.1,
    )
    words = dict.fromkeys(
        ("apparatus_most", "bound", "low_open", "high_open", "method", "verdict"), ""
    )
    rows = [
        {"parameter": name, "estimate": value, **numbers, **words}
        for name, value in zip(study.imp.estimate, truth, strict=True)
    ]
    write_csv(results.identification("estimate.csv"), pd.DataFrame(rows))
    channel = noise_of("slab_60", "mlr", points=1, sd=1.0, chi2=1.0)
    chi2 = float(residuals @ residuals)
    write_noise(
        results, "imp", StageNoise(channels=[channel], chi2=chi2, freedom=50.0, dispersion=1.0)
    )
    return results


@pytest.fixture(scope="module")
def results(study: Study, identified: Results, tmp_path_factory: pytest.TempPathFactory) -> Results:
    found = copied(identified, tmp_path_factory.mktemp("drawn") / "smoke")
    run(study, found, print, 1)
    write_options(study, found, "posterior")
    PAGE.write(study, found)
    return found


def copied(results: Results, to: Path) -> Results:
    shutil.copytree(results.root, to)
    return Results(to)


def test_two_processes_leave_the_same_bytes(
    study: Study, identified: Results, results: Results, tmp_path: Path
) -> None:
    there = copied(identified, tmp_path / "two")
    run(study, there, print, 2)
    names = (
        posterior.FILE,
        posterior.SAMPLES,
        posterior.ENSEMBLE,
        posterior.BANDS,
        "sets/0003.json",
    )
    for name in names:
        assert (
            there.of_step("posterior", name).read_bytes()
            == results.of_step("posterior", name).read_bytes()
        ), name


def test_short_ensembles_are_told_in_the_first_sentence(study: Study, results: Results) -> None:
    found = posterior.read(study, results)
    assert not found.converged
    assert (found.steps, found.walkers, found.calls) == (STEPS, 12, 4 * 12 * (STEPS + 1))
    assert "did NOT converge: do not use its numbers" in sentences(study, results)[0]


def test_known_value_narrows_its_parameter(study: Study, results: Results) -> None:
    of = {p.name: p for p in posterior.read(study, results).parameters}["k"]
    assert of.sd < 0.008
    assert abs(of.mean - 0.2) < 0.012


def test_ensemble_has_equal_weights_and_files_that_exports_read(
    study: Study, results: Results, tmp_path: Path
) -> None:
    ensemble = read_csv(results.of_step("posterior", posterior.ENSEMBLE))
    assert len(ensemble) == SETS
    assert ensemble["weight"].to_numpy() == pytest.approx(1.0 / SETS)
    assert len(list(results.of_step("posterior", posterior.SETS).glob("*.json"))) == SETS
    path = results.of_step("posterior", "sets/0002.json")
    chosen = parameter_set(study, results, str(path), tmp_path)
    for name in study.imp.estimate:
        assert chosen.values[name] == ensemble.iloc[1][name]
        low, high = study.parameters[name].bounds_si
        assert low <= chosen.values[name] <= high


def test_bands_of_all_signals_enclose_their_medians(study: Study, results: Results) -> None:
    frame = posterior.read_predicted_bands(results)
    roles = frame.groupby(["experiment", "signal"])["role"].first().to_dict()
    assert roles[("slab_60", "mlr")] == "fitted"
    assert set(roles.values()) == {"fitted", "held out"}
    for kind in ("", "parameters_"):
        assert (frame[f"{kind}low"] <= frame[f"{kind}median"]).all()
        assert (frame[f"{kind}median"] <= frame[f"{kind}high"]).all()
    for of in posterior.read(study, results).bands:
        # What the model lacks is known in the mass loss rate alone.
        assert of.lacking == (of.signal == "mlr")
        assert of.inside is not None
        if of.role == "held out" and of.lacking:
            assert of.width > of.parameters_width


def test_page_has_figures_tables_and_the_ensemble(study: Study, results: Results) -> None:
    shown = PAGE.section(study, results)
    assert [type(part).__name__ for part in shown.parts] == ["Picture"] * 2 + ["Passage"] * 3
    assert "use the ensemble of 12 sets" in shown.said[-1]
    assert any("No fitted signal determines the model discrepancy" in line for line in shown.said)
    table = results.of_step("posterior", "table_parameters.md").read_text()
    assert "R-hat" in table
    assert "kg/m3" in table


def command(results: Results, folder: Path, *options: str, **changes: Any) -> list[str]:
    path = folder / "mine.yaml"
    path.write_text(yaml.safe_dump(given(**CHANGES, **changes), sort_keys=False))
    return ["posterior", str(path), "--results", str(results.root), *options]


def test_study_that_has_not_run_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    nowhere = Results(tmp_path / "nowhere")
    assert main(command(nowhere, tmp_path)) == 2
    said = capsys.readouterr().err
    assert f"{nowhere.identification('estimate.csv')}: this result is missing" in said
    assert "snakemake --cores 2 --configfile" in said


def test_study_that_was_changed_is_refused(
    identified: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    there = copied(identified, tmp_path / "there")
    path = there.identification("noise.json")
    write_json(path, json.loads(path.read_text()) | {"chi2": 1e5})
    assert main(command(there, tmp_path)) == 2
    said = capsys.readouterr().err
    assert "this belongs to another description of the study" in said
    assert "Run the study again" in said


@pytest.mark.parametrize("option", ["--sets=0", "--steps=3"])
def test_numbers_are_checked(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(command(Results(tmp_path), tmp_path, option)) == 2
    name, _, text = option.partition("=")
    assert f"{name}: '{text}' must be at least" in capsys.readouterr().err
