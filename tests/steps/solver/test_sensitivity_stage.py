"""Sensitivity of a small study: what varies, indices, files, messages."""

import contextlib
import io
import re
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import yaml
from twin_of_sensitivity import SAMPLES, described

from pyrofit.cli import main
from pyrofit.config import Study, as_study
from pyrofit.config.keys.steps import with_options
from pyrofit.errors import DataError
from pyrofit.results.files import Results, read_csv, write_csv
from pyrofit.stages import measurements
from pyrofit.steps.sensitivity import record as sensitivity
from pyrofit.steps.sensitivity.compute import run
from pyrofit.steps.sensitivity.page import PAGE
from pyrofit.steps.sensitivity.sentences import sentences


def with_few(study: Study, **options: Any) -> Study:
    """Return a study that asks for the fewest base points."""
    steps = with_options(study.steps, "sensitivity", {"samples": 8, **options})
    return study.model_copy(update={"steps": steps})


def command(results: Results, folder: Path, *options: str) -> list[str]:
    path = folder / "mine.yaml"
    path.write_text(yaml.safe_dump(described(), sort_keys=False))
    return ["sensitivity", str(path), "--results", str(results.root), *options]


@pytest.fixture(scope="module")
def study() -> Study:
    return as_study(described(), "smoke.yaml")


@pytest.fixture(scope="module")
def made(study: Study, tmp_path_factory: pytest.TempPathFactory) -> tuple[Results, str]:
    """The analysis of a small sample by the command, and what it prints."""
    folder = tmp_path_factory.mktemp("sensitivity")
    results = Results(folder / "smoke")
    measurements.prepare(study, results)
    with contextlib.redirect_stdout(io.StringIO()) as said:
        assert main(command(results, folder)) == 0
    return results, said.getvalue()


@pytest.fixture(scope="module")
def results(made: tuple[Results, str]) -> Results:
    return made[0]


def total(results: Results, signal: str) -> pd.DataFrame:
    """Return total indices by time and input."""
    frame = read_csv(results.of_step("sensitivity", sensitivity.OVER_TIME))
    mine = frame[frame["signal"] == signal]
    return mine.pivot(index="time_s", columns="input", values="total").dropna()


def test_estimated_parameters_and_the_apparatus_vary(study: Study, results: Results) -> None:
    found = sensitivity.read(study, results)
    kinds = {one.name: one.kind for one in found.inputs}
    assert {n for n, kind in kinds.items() if kind == "estimated"} == set(study.imp.estimate)
    assert {"slab_25_flux", "slab_25_thickness", "slab_25_h", "slab_25_back_loss"} <= set(kinds)
    assert kinds["emissivity_residue"] == "apparatus"
    assert found.runs == SAMPLES * (len(found.inputs) + 2)


def test_no_rate_depends_on_the_heat_of_reaction_before_anything_reacts(
    study: Study, results: Results
) -> None:
    early = total(results, "back_temperature").loc[20:40]
    assert len(early) > 2
    assert early["dh"].max() < 1e-3
    assert early["slab_25_thickness"].max() > 1e-3
    assert early[["k", "cp", "rho", "eps", "slab_25_start"]].sum(axis=1).min() > 0.9


def test_costs_have_indices_and_those_that_differ_by_a_factor_are_one(
    study: Study, results: Results
) -> None:
    found = sensitivity.read(study, results)
    costs = {cost.name: cost for cost in found.costs}
    assert {"RMSE", "NRSE", "THR_above", "chi2", "GPYRO_all"} <= set(costs)
    assert any({"RMSE", "NRMS"} <= set(group) for group in found.same)
    assert costs["RMSE"].at_s is None
    assert costs["NRSE"].at_s is not None
    for cost in costs.values():
        assert min(cost.total.values()) >= 0.0


def test_sentences_tell_the_time_of_a_single_value_and_the_one_equation(
    study: Study, results: Results
) -> None:
    found = sensitivity.read(study, results)
    cost = next(cost for cost in found.costs if cost.name == "NRSE")
    said = " ".join(sentences(study, results))
    assert f"NRSE looks at {cost.at_s:.0f} s alone" in said
    assert f"one equation for {len(study.imp.estimate)} parameters" in said


def test_two_processes_leave_the_same_bytes(
    study: Study, results: Results, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pyrofit.steps.sensitivity.compute.AT_ONCE", 64)
    names = (sensitivity.FILE, sensitivity.OVER_TIME, sensitivity.COSTS, sensitivity.CURVES)
    found = []
    for cores in (1, 2):
        there = Results(tmp_path / str(cores))
        measurements.prepare(study, there)
        run(with_few(study), there, print, cores)
        found.append([there.of_step("sensitivity", name).read_bytes() for name in names])
    assert found[0] == found[1]


def test_what_the_study_says_of_the_apparatus_counts(tmp_path: Path) -> None:
    keys = described()
    keys["experiments"]["slab_25"]["uncertain"] = {"flux_sd": 0.05}
    keys["diagnosis"] = {"kinetics": "described"}
    study = as_study(keys, "smoke.yaml")
    results = Results(tmp_path)
    measurements.prepare(study, results)
    run(with_few(study), results, print, 1)
    inputs = [i for i in sensitivity.read(study, results).inputs if i.name == "slab_25_flux"]
    assert [(i.kind, i.mean, i.sd) for i in inputs] == [("known", 1.0, 0.05)]


def test_near_and_intervals_lie_about_the_estimates(
    study: Study, results: Results, tmp_path: Path
) -> None:
    there = Results(tmp_path)
    measurements.prepare(study, there)
    values = {"rho": 1190.0, "k": 0.2, "cp": 2100.0, "eps": 0.9, "dh": 800e3}
    frame = pd.DataFrame({"parameter": values.keys(), "estimate": values.values()})
    frame = frame.assign(sd=0.01 * frame["estimate"], apparatus_sd=1.0, method="linear")
    write_csv(there.identification("estimate.csv"), frame)
    for within, reach in (("near", None), ("intervals", 0.03)):
        run(with_few(study, within=within), there, print, 1)
        for one in sensitivity.read(study, there).inputs:
            if one.kind == "estimated":
                value = values[one.name] / study.parameters[one.name].factor
                assert one.low < value < one.high
                assert one.mean == pytest.approx(value)
                if reach and one.name == "rho":
                    assert one.high == pytest.approx(1.03 * value)


def test_page_has_figures_numbers_and_table(study: Study, results: Results) -> None:
    shown = PAGE.section(study, results)
    assert [type(part).__name__ for part in shown.parts] == ["Picture"] * 3 + ["Passage"]
    assert "estimated parameters over their limits" in shown.said[0]
    for name in ("total", "apparatus", "first", "costs"):
        assert results.of_step("sensitivity", f"{name}.png").stat().st_size > 0


def test_command_prints_the_sentences(study: Study, made: tuple[Results, str]) -> None:
    assert made[1].splitlines() == sentences(study, made[0])
    assert "The back temperature of slab_25 depends most on" in made[1]


def test_missing_estimates_are_told_with_the_way_out(
    study: Study, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    nowhere = Results(tmp_path / "nowhere")
    measurements.prepare(study, nowhere)
    assert main(command(nowhere, tmp_path, "--within", "near")) == 2
    said = capsys.readouterr().err
    assert f"{nowhere.identification('estimate.csv')}: this result is missing; run" in said


def test_missing_measurements_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(command(Results(tmp_path / "nowhere"), tmp_path)) == 2
    assert "is missing; run the workflow to make it" in capsys.readouterr().err


@pytest.mark.parametrize("count", ["0", "7", "100", "many"])
def test_number_of_samples_is_checked(
    count: str, results: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(command(results, tmp_path, f"--samples={count}")) == 2
    said = capsys.readouterr().err
    assert re.search(f"--samples: '{count}'(: give a power of two| is not a whole number)", said)


def test_result_of_another_study_is_refused(study: Study, results: Results) -> None:
    other = study.model_copy(update={"name": "other"})
    with pytest.raises(DataError, match="result of another study"):
        sensitivity.read(other, results)
