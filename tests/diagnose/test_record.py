"""The results hold what the documentation says, all of it, and add up."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from hidden_effects import Diagnosed
from small import LIMITS, TRUTH, measured, study

from pyrofit.diagnose.diagnosis import DiagnosisWork, examine
from pyrofit.effects import known_effects
from pyrofit.results.diagnosis_schema import Diagnosis as Schema

PAGE = Path(__file__).parents[2] / "docs" / "diagnosis.md"


@pytest.fixture(scope="module")
def results(
    diagnosed: Diagnosed, unexplained: DiagnosisWork, undecided: DiagnosisWork
) -> list[Schema]:
    return [unexplained.content, undecided.content, diagnosed("k_T").content]


def test_kinds_of_the_results_that_are_compared_differ(results: list[Schema]) -> None:
    assert [r.verdict.kind for r in results] == ["unknown", "ambiguous", "named"]


def test_results_are_as_the_schema_says(results: list[Schema]) -> None:
    for content in results:
        whole = content.model_dump_json(by_alias=True)
        assert Schema.model_validate_json(whole) == content


def test_columns_of_the_curves_are_documented(diagnosed: Diagnosed) -> None:
    text = PAGE.read_text(encoding="utf-8")
    line = text[text.index("`curves.csv`: ") :].split("\n\n")[0]
    assert re.findall(r"`(\w+)`", line) == list(diagnosed("k_T").curves.columns)


def test_results_are_plain_json(results: list[Schema]) -> None:
    for content in results:
        text = json.dumps(content.model_dump(by_alias=True), allow_nan=False)
        assert json.dumps(json.loads(text)) == text


def test_gap_is_that_of_the_curves(diagnosed: Diagnosed) -> None:
    found = diagnosed("k_T")
    for row in found.content.gap:
        part = found.curves.query("experiment == @row.experiment and signal == @row.signal")
        for when in ("before", "after"):
            rms = float(np.sqrt(np.mean((part[when] - part["measured"]) ** 2)))
            assert getattr(row, f"rms_{when}") == pytest.approx(rms, rel=1e-12)
        assert row.noise_sd == part["sd"].median()
        assert row.points == len(part)


def test_held_out_signals_tell_where_a_prediction_promises_enough() -> None:
    signals = ["mlr", "back_temperature"]
    described = study(
        effects=["k_T", "c_T"], calibrate={"slab_25": signals}, hold_out={"slab_60": signals}
    )
    content = examine(described, measured({"k_T": -1e-3}, 2), advise=False).content
    (evidence,) = content.verdict.evidence
    gain = evidence.expected["held out"]
    tells = gain is None or gain >= content.settings["informative_gain"]
    assert {row.tells for row in content.gap if row.role == "held out"} == {tells}
    assert {row.tells for row in content.gap if row.role != "held out"} == {None}


def test_chi_squares_of_the_channels_add_up(diagnosed: Diagnosed) -> None:
    content = diagnosed("k_T").content
    total = sum(row.chi2_before for row in content.gap)
    assert content.base.chi2 == pytest.approx(total, rel=1e-12)
    best = content.candidates[0]
    assert best.effects == ["k_T"]
    assert best.chi2 == pytest.approx(sum(r.chi2_after for r in content.gap), rel=1e-12)
    assert best.gain == pytest.approx(total - best.chi2, rel=1e-12)
    noise = {(r.experiment, r.signal): r.chi2_base for r in content.noise}
    gap = {(r.experiment, r.signal): r.chi2_before for r in content.gap}
    assert noise == gap


def test_parameters_of_the_base_are_in_the_units_of_the_study(diagnosed: Diagnosed) -> None:
    found = diagnosed("nothing").content.base.parameters
    assert {name: p.unit for name, p in found.items()} == {n: u for n, (u, *_) in LIMITS.items()}
    for name, p in found.items():
        _, lower, upper = LIMITS[name]
        assert lower <= p.low < p.value < p.high <= upper
        factor = 1e3 if LIMITS[name][0].startswith("kJ") else 1.0
        # The widest, that of dh, spans a tenth of its limits.
        assert abs(p.value - TRUTH[name] / factor) < 1.5 * (p.high - p.low)


def test_effects_that_are_screened_are_in_order_of_their_score(diagnosed: Diagnosed) -> None:
    content = diagnosed("k_T").content
    scores = [row.z for row in content.screen]
    assert scores == sorted(scores, reverse=True)
    assert content.base.score == max(scores)
    assert set(content.confusability.effects) == {row.effect for row in content.screen}
    cosine = np.array(content.confusability.cosine)
    assert np.diag(cosine) == pytest.approx(np.ones(len(scores)))
    for row in content.screen:
        assert row.group == known_effects()[row.effect].group


def test_probes_come_with_an_unknown_effect_only(
    unexplained: DiagnosisWork, undecided: DiagnosisWork
) -> None:
    absorbed = {probe.probe: probe.absorbed for probe in unexplained.content.probes}
    assert max(absorbed, key=lambda name: absorbed[name]) == "flux"
    assert undecided.content.probes == []


def test_next_experiment_separates_what_is_not_told_apart(undecided: DiagnosisWork) -> None:
    effects = undecided.content.verdict.sets[0]
    assert len(effects) > 1
    best = undecided.content.next_experiment[0]
    assert best.separation_sd == min(best.pairs.values())
    named = {name for pair in best.pairs for name in pair.split(" | ")}
    assert named <= set(effects)
