"""Worth of planned tests of a small study: numbers, check by refits, files, messages."""

import contextlib
import io
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from stage_studies import searched_by_hand
from twin_of_sensitivity import described

from pyrofit.analysis import data_worth
from pyrofit.cli import main
from pyrofit.config import Study, as_study
from pyrofit.config.keys.steps import with_options
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.errors import DataError
from pyrofit.estimate.posterior import curvature
from pyrofit.results.files import Results, write_csv
from pyrofit.stages import measurements
from pyrofit.steps.worth import record as worth
from pyrofit.steps.worth.apparatus import lasting_of
from pyrofit.steps.worth.best_fit import best_fit
from pyrofit.steps.worth.compute import run
from pyrofit.steps.worth.facts import share_left
from pyrofit.steps.worth.page import PAGE, sentences
from pyrofit.steps.worth.planned import Planned, planned

TRUTH = {"rho": 1190.0, "k": 0.2, "cp": 2100.0, "eps": 0.9, "dh": 800e3}
DRAWS = 6


def keys() -> dict[str, Any]:
    """Return the small study, with both signals of the fitted test."""
    study = described()
    study["steps"] = {"worth": {"draws": DRAWS}}
    study["experiments"]["slab_25"]["duration_s"] = 900
    study["imp"]["identification"] = {"slab_25": ["mlr", "back_temperature"]}
    return study


def asking(study: Study, **options: Any) -> Study:
    """Return a study with other options of the step."""
    return study.model_copy(update={"steps": with_options(study.steps, "worth", options)})


def prepared(study: Study, folder: Path) -> Results:
    """Return results with measurements, searches and estimates: the truth."""
    results = Results(folder)
    measurements.prepare(study, results)
    searched_by_hand(study, results, TRUTH)
    frame = pd.DataFrame({"parameter": TRUTH.keys(), "estimate": TRUTH.values()})
    write_csv(results.identification("estimate.csv"), frame.assign(sd=1.0))
    return results


def command(results: Results, folder: Path, *options: str) -> list[str]:
    path = folder / "mine.yaml"
    path.write_text(yaml.safe_dump(keys(), sort_keys=False))
    return ["worth", str(path), "--results", str(results.root), *options]


@pytest.fixture(scope="module")
def study() -> Study:
    return as_study(keys(), "smoke.yaml")


@pytest.fixture(scope="module")
def made(study: Study, tmp_path_factory: pytest.TempPathFactory) -> tuple[Results, str]:
    """The worth of all tests by the command, and what it prints."""
    folder = tmp_path_factory.mktemp("worth")
    results = prepared(study, folder / "smoke")
    with contextlib.redirect_stdout(io.StringIO()) as said:
        assert main(command(results, folder)) == 0
    return results, said.getvalue()


@pytest.fixture(scope="module")
def results(made: tuple[Results, str]) -> Results:
    return made[0]


@pytest.fixture(scope="module")
def fitted(study: Study, results: Results) -> FittedModel:
    return best_fit(study, results)


@pytest.fixture(scope="module")
def tests(study: Study, fitted: FittedModel) -> dict[str, Planned]:
    return {test.name: test for test in planned(study, fitted)[0]}


def test_tests_are_other_fluxes_slabs_sensors_calorimetry_and_repeats(
    tests: dict[str, Planned],
) -> None:
    assert {
        "flux_60_kW_m2",
        "flux_60_kW_m2+back_temperature",
        "slab_25_half_thickness",
        "slab_25_insulated_back",
        "slab_25_again",
        "slab_25_again+front_temperature",
        "slab_25_again+in_depth_temperature",
        "dsc_10_K_min",
    } <= set(tests)
    again = tests["slab_25_again+in_depth_temperature"].record
    assert list(again.noise) == ["mlr", "back_temperature", "in_depth_temperature"]


def test_temperature_at_half_the_depth_lies_between_the_faces(tests: dict[str, Planned]) -> None:
    front = tests["slab_25_again+front_temperature"].record.forecast.curves
    inner = tests["slab_25_again+in_depth_temperature"].record.forecast.curves
    T = inner["in_depth_temperature"][20:60]
    assert np.all(front["back_temperature"][20:60] < T)
    assert np.all(front["front_temperature"][20:60] > T)


def test_whitened_derivatives_are_those_of_the_refits(
    fitted: FittedModel, tests: dict[str, Planned]
) -> None:
    for name in ("flux_60_kW_m2+back_temperature", "dsc_10_K_min"):
        record, x = tests[name].record, fitted.fit.x
        step = np.zeros(x.size)
        i = fitted.model.names.index("cp")
        step[i] = 1e-3
        sets = np.array([x, x + step, x - step])
        _, high, low = record.whitened(fitted.model.likelihood, sets, led=True)
        assert high is not None
        assert low is not None
        quotient = (high - low) / 2e-3
        size = np.linalg.norm(record.jacobian[:, i])
        assert np.linalg.norm(quotient - record.jacobian[:, i]) < 0.02 * size


def test_a_test_with_the_very_same_record_leaves_the_root_of_half(fitted: FittedModel) -> None:
    jacobian = fitted.fit.jacobian
    before = curvature(jacobian) - 12.0 * np.eye(jacobian.shape[1])
    after = data_worth.narrowed(before, jacobian, 1.0)
    free = range(len(before))
    sds = [data_worth.sds(part, free) for part in (before, after)]
    assert data_worth.left(*sds) == pytest.approx(0.5**0.5)


def test_a_further_sensor_is_never_worth_less(study: Study, results: Results) -> None:
    found = {test.name: test for test in worth.read(study, results).tests}
    for more, less in (
        ("flux_60_kW_m2+back_temperature", "flux_60_kW_m2"),
        ("slab_25_again+front_temperature", "slab_25_again"),
    ):
        for name, sd in found[more].sds.parameters.items():
            assert sd <= found[less].sds.parameters[name] * (1.0 + 1e-9)
        assert found[more].gain_bit > found[less].gain_bit > 0.0


def test_tests_are_ranked_and_narrow_what_is_predicted(study: Study, results: Results) -> None:
    found = worth.read(study, results)
    left = [test.left for test in found.tests]
    assert left == sorted(left)
    assert set(found.predictions) == {"slab_60 mlr", "slab_60 back_temperature"}
    assert max(left) <= 1.0
    assert [test.checked is not None for test in found.tests[:4]] == [True, True, True, False]


def test_refits_of_drawn_data_agree_with_the_linear_numbers(study: Study, results: Results) -> None:
    found = worth.read(study, results)
    for test in found.tests[:3]:
        linear, drawn = share_left(found, test), share_left(found, test, checked=True)
        apart = [drawn[name] - linear[name] for name in linear]
        assert np.mean(np.abs(apart)) < 20.0  # percentage points, of six draws
    assert found.now_checked is not None
    for name, sd in found.now.predictions.items():
        assert 0.4 < found.now_checked.predictions[name] / sd < 2.0


def test_whitening_leaves_noise_and_apparatus_white() -> None:
    rng = np.random.default_rng(1)
    moves = [rng.standard_normal(40) * size for size in (0.1, 1.0, 30.0)]
    V = np.column_stack(moves) / 2.0**0.5
    T = lasting_of(moves, 2.0).whiten(np.eye(40))
    assert np.allclose(T @ (np.eye(40) + V @ V.T) @ T.T, np.eye(40), atol=1e-9)


def test_uncertain_apparatus_leaves_estimates_wider_and_repeats_worth_less(
    study: Study, results: Results, tmp_path: Path
) -> None:
    there = prepared(study, tmp_path)
    run(asking(study, draws=0, apparatus="uncertain"), there, print, 1)
    wide, exact = worth.read(study, there), worth.read(study, results)
    for name, sd in exact.now.parameters.items():
        assert wide.now.parameters[name] >= sd * (1.0 - 1e-9)
    # Density times thickness is the mass, and the thickness is known to 2 %.
    assert wide.now.parameters["rho"] > 3.0 * exact.now.parameters["rho"]
    assert wide.tests[0].checked is None
    assert "With the apparatus taken as uncertain" in sentences(study, there)[0]


def test_calorimetry_tells_nothing_of_the_conductivity(study: Study, fitted: FittedModel) -> None:
    test = {t.name: t for t in planned(study, fitted)[0]}["dsc_10_K_min"]
    J = dict(zip(fitted.model.names, test.record.jacobian.T, strict=True))
    assert np.linalg.norm(J["dh"]) > 1.0
    assert np.linalg.norm(J["k"]) < 1e-6 * np.linalg.norm(J["dh"])


def test_two_processes_leave_the_same_bytes(study: Study, results: Results, tmp_path: Path) -> None:
    found = []
    for cores in (1, 2):
        there = prepared(study, tmp_path / str(cores))
        run(asking(study, draws=2), there, print, cores)
        found.append(there.of_step("worth", worth.FILE).read_bytes())
    assert found[0] == found[1]


def test_page_has_figure_table_and_sentences(study: Study, made: tuple[Results, str]) -> None:
    shown = PAGE.section(study, made[0])
    assert [type(part).__name__ for part in shown.parts] == ["Picture", "Passage"]
    assert made[1].splitlines() == sentences(study, made[0]) == list(shown.said)
    assert "narrows parameters and predictions most" in shown.said[0]
    assert "The best 3 were checked by refits of 6 drawn data sets" in shown.said[1]
    assert made[0].of_step("worth", "worth.png").stat().st_size > 0


def test_missing_estimates_are_told_with_the_way_out(
    study: Study, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    nowhere = Results(tmp_path / "nowhere")
    measurements.prepare(study, nowhere)
    assert main(command(nowhere, tmp_path)) == 2
    said = capsys.readouterr().err
    assert f"{nowhere.identification('estimate.csv')}: this result is missing; run" in said


@pytest.mark.parametrize(
    ("count", "rule"),
    [
        ("1", ": give a whole number from 2 to 1000, or 0"),
        ("-3", " must be at least 0"),
        ("many", " is not a whole number"),
        ("2000", " must be at most 1000"),
    ],
)
def test_number_of_draws_is_checked(
    count: str, rule: str, results: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(command(results, tmp_path, f"--draws={count}")) == 2
    assert f"--draws: '{count}'{rule}" in capsys.readouterr().err


def test_result_of_another_study_is_refused(study: Study, results: Results) -> None:
    other = study.model_copy(update={"name": "other"})
    with pytest.raises(DataError, match="result of another study"):
        worth.read(other, results)
