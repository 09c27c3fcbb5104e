"""The step of a study: its results, the study with the chosen scheme, and what is drawn."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from scheme_truths import make_scheme_twin

from pyrofit.config import Study, read_study
from pyrofit.errors import DataError
from pyrofit.results.files import Results, write_csv
from pyrofit.results.step import exists
from pyrofit.scheme.arrangements.base import PREFIX
from pyrofit.scheme.choice import Choice
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.settings import SchemeSettings
from pyrofit.simulate import simulate_tga
from pyrofit.solver.curves import Request
from pyrofit.steps.scheme import record as scheme
from pyrofit.steps.scheme.compute import run, write
from pyrofit.steps.scheme.page import PAGE


@dataclass(frozen=True)
class Made:
    study: Study
    results: Results
    choice: Choice
    truth: Mapping[str, float]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    twin = make_scheme_twin(Scheme(order=True), 21, SchemeSettings())
    setting = twin.setting
    results = Results(tmp_path_factory.mktemp("results"))
    for (name, signal), frame in setting.measurements.items():
        write_csv(results.measurement(name, signal), frame)
    choice = run(setting.study, results, print, 1)
    return Made(setting.study, results, choice, twin.truth)


def test_truth_of_order_n_is_chosen_and_recovered(made: Made) -> None:
    chosen = made.choice.chosen.fitted
    assert chosen.name == "single_order"
    for key, within in (("T_1", 2.0), ("E_1", 1e4), ("n_1", 0.1)):
        name = PREFIX + key
        assert chosen.values[name] == pytest.approx(made.truth[name], abs=within)


def test_what_is_written_is_what_was_chosen(made: Made) -> None:
    found = scheme.read(made.study, made.results)
    assert found.chosen == made.choice.chosen.fitted.name == "single_order"
    rows = {s.name: s for s in found.schemes}
    assert rows["single_order"].bic == min(s.bic for s in found.schemes)
    assert found.own.words == "the scheme of the study"
    # The study's scheme is one reaction of first order.
    assert found.own.bic == pytest.approx(rows["single"].bic, abs=0.1)
    assert [r.calibrated for r in found.own.records] == [True] * 3 + [False] * 4


def test_intervals_hold_the_fit_and_stay_within_limits(made: Made) -> None:
    for p in scheme.read(made.study, made.results).parameters.values():
        assert p.low <= p.value <= p.high


def test_study_with_the_chosen_scheme_simulates_the_chosen_curves(made: Made) -> None:
    extended = read_study(made.results.of_step("scheme", scheme.EXTENDED))
    assert extended.imp.kinetics == "described"
    assert not {"T", "E"} & set(extended.parameters)
    curves = scheme.read_scheme_curves(made.results)
    here = curves[curves["experiment"] == "tga_10"]
    asked = Request(
        here["time_s"].to_numpy(float),
        temperature_K=here["temperature_K"].to_numpy(float),
        output="mass_fraction",
        heating_rate_K_s=np.full(len(here), 1.0 / 6.0),
    )
    found = simulate_tga(
        extended.experiments["tga_10"],  # type: ignore[arg-type]
        extended.material,
        extended.fixed_values(),
        asked,
        extended.accuracy,
    )
    assert found.signals["mass_fraction"] == pytest.approx(here["after"].to_numpy(float), abs=2e-4)


def test_study_with_the_chosen_scheme_finds_its_files_from_anywhere(
    made: Made, tmp_path: Path
) -> None:
    write(made.study, made.results, made.choice, tmp_path / "chosen.yaml")
    chosen = read_study(tmp_path / "chosen.yaml")
    before, after = (
        Path(study.experiments["tga_10"].signals["mass_fraction"].file).resolve()
        for study in (made.study, chosen)
    )
    assert after == before


def test_tables_and_figure_are_written_and_make_a_section(made: Made) -> None:
    assert not exists(made.study, made.results, "scheme")
    PAGE.write(made.study, made.results)
    assert exists(made.study, made.results, "scheme")
    section = PAGE.section(made.study, made.results)
    assert "one reaction of order n" in section.said[0]


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("chosen", "two_in_parallel", "another study"),
        ("study", "other", "another study"),
        ("schemes", [], "'schemes'"),
    ],
)
def test_broken_results_are_refused(
    key: str, value: object, message: str, made: Made, tmp_path: Path
) -> None:
    content = json.loads(made.results.of_step("scheme", scheme.FILE).read_text(encoding="utf-8"))
    other = Results(tmp_path)
    other.folder("scheme").mkdir()
    text = json.dumps({**content, key: value})
    other.of_step("scheme", scheme.FILE).write_text(text, encoding="utf-8")
    with pytest.raises(DataError, match=message):
        scheme.read(made.study, other)
