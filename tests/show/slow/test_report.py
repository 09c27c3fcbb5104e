import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from report_pages import Page, tables_of, write_tables, written
from shown_studies import described, fake, made, synthetic

from pyrofit.analysis.answer import one_each
from pyrofit.analysis.best_predicting import best_predicting
from pyrofit.analysis.estimates import Estimated, estimates_of
from pyrofit.config import Study, as_study
from pyrofit.errors import DataError
from pyrofit.model.parameters import Parameter
from pyrofit.results import identification
from pyrofit.results.files import Results, read_csv, read_json, write_csv, write_json, write_text
from pyrofit.results.goodness import ONE_RATE
from pyrofit.results.step import write_options
from pyrofit.show.facts import Facts, facts_of
from pyrofit.show.report import write_report
from pyrofit.show.sections import FIGURES, TABLES
from pyrofit.show.subjects.answer.next_steps import advice, next_steps
from pyrofit.show.subjects.answer.summary import summary
from pyrofit.show.subjects.truth.sentences import errors_of_sets as sentences
from pyrofit.show.table import write_table
from pyrofit.steps.posterior import record as posterior
from pyrofit.steps.preview import record as preview
from pyrofit.steps.preview.inputs import INPUTS
from pyrofit.steps.rescore import record as rescored
from pyrofit.steps.rescore.page import PAGE as RESCORE
from pyrofit.steps.robustness.options import RobustnessOptions
from pyrofit.steps.robustness.page import TABLE as ROBUSTNESS


def test_report_has_all_sections_and_figures(tmp_path: Path) -> None:
    page, _ = written(tmp_path)
    sections = ["summary", "data", "isoconversional"]
    sections += ["kinetics", "validation", "identification", "fit"]
    sections += ["optimisation", "costs", "provenance"]
    assert [i for i in page.ids if i not in FIGURES] == sections
    study, _ = fake(tmp_path)
    shown = {name for name, figure in FIGURES.items() if figure.applies(study)}
    # The faked study has no heat flow, no heat release, and nothing without a measurement.
    assert set(FIGURES) - shown == {"heats", "unmeasured"}
    assert shown <= set(page.ids)
    assert page.tags.count("figcaption") == len(shown)
    assert len(set(page.ids)) == len(page.ids)


def test_figure_of_half_the_width_is_shown_at_half_the_width(tmp_path: Path) -> None:
    # 170 mm are 481.9 pt.
    _, text = written(tmp_path)
    study, _ = fake(tmp_path)
    shown = [name for name, figure in FIGURES.items() if figure.applies(study)]
    assert text.count('style="--share: 0.5"') == len(shown)


def test_report_loads_nothing(tmp_path: Path) -> None:
    page, text = written(tmp_path)
    assert page.loads
    assert all(load.startswith(("data:image/svg+xml;base64,", "#")) for load in page.loads)
    assert "http" not in re.sub(r"base64,[A-Za-z0-9+/=]+", "", text)
    assert not {"link", "iframe"} & set(page.tags)
    assert page.tags.count("script") == text.count("<script>") == 1
    assert "url(" not in text
    assert "@import" not in text


def summary_of(text: str) -> dict[str, list[str]]:
    """Return the sentences of the summary by their question."""
    first = text.split('<section id="summary">')[1].split("</section>")[0]
    found = re.findall(r"<h3>([^<]*\?)</h3>\s*<ol>(.*?)</ol>", first, re.S)
    return {question: re.findall(r"<li>(.*)</li>", listed) for question, listed in found}


DESCRIBES = "Does the model describe the tests?"
PUBLISH = "Which values can I publish?"
NEXT = "What should I do next?"
DESCRIBED = (
    "The model of the kinetics describes the tests: its misfit is within their noise (p = 0.4)."
)
MISSED = (
    "The model of the inverse modelling does not describe the tests: it misses 1 of 1 signal by "
    "more than noise does (p = 0.002). The rms misfit is at most 5 % of a signal's range. slab_25, "
    "mass loss rate: simulated 0.3 g/(m² s) too low from 20 to 60 s."
)


def test_first_screen_answers_three_questions_in_order(tmp_path: Path) -> None:
    _, text = written(tmp_path)
    said = summary_of(text)
    assert list(said) == [DESCRIBES, PUBLISH, NEXT]
    assert said[DESCRIBES] == [DESCRIBED, MISSED.replace("'", "&#39;")]
    assert said[PUBLISH] == [
        "cp (upper) is at a limit: the best fit lies outside the limits. Such a value is the "
        "limit&#39;s, and the others depend on it.",
        "The data determine 2 of 3 parameters: T_p and k (95 % interval narrower than 20 % of the "
        "search range). Publish T_p with its interval. Intervals of k hold only with the limits "
        "reached: mend these first. Undetermined: cp (70.0 %, upper limit). "
        "In brackets: the width of the 95 % interval over the search range. "
        "Do not quote cp alone: other values fit as well.",
        "Usual errors of the apparatus move k by ± 0.098 W/(m K) (mostly thickness), farther than "
        "the interval (standard deviations: flux 3 %, thickness 2 %, h 2 W/(m² K), gas "
        "temperature 10 K, initial temperature 2 K, loss of the back 10 %, flame 5 kW/m²). "
        "Publish both.",
        "Assumed, not estimated: h of the front 0 W/(m² K) (slab_25); an insulated back "
        "(slab_25). The step sensitivity tells how much they matter.",
    ]
    assert said[NEXT] == [
        "Widen the limits of cp if the material allows it; else look for the effect that the model "
        "lacks.",
        "Inverse modelling: the step diagnose searches the missing effect (pyrofit run STUDY "
        "diagnose).",
        "To predict, use all estimates together (pyrofit export fds STUDY writes them). The model "
        "misses its tests: expect errors of that size or larger. At held-out tests the estimates "
        "predict the mass loss rate with CV(RMSE) 0.450 and the back temperature with RMSE 7.20 K.",
    ]


def test_study_without_held_out_tests_says_that_predictions_are_untested(tmp_path: Path) -> None:
    given = described()
    given["validation"]["experiments"] = ["slab_25"]
    _, text = written(tmp_path, given)
    assert summary_of(text)[NEXT][-1].endswith(
        "No test was held out, so the prediction of other tests is untested."
    )


def facts_in(study: Study, results: Results) -> Facts:
    write_tables(study, results)
    return facts_of(study, results, tables_of(study, results))


def test_report_says_what_chi_square_near_one_is_for_beside_a_misfit(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = facts_in(study, results)
    beginning = "Chi-square per point, "
    assert not any(text.startswith(beginning) for text in told(study, facts))
    # 19.8 over 18 degrees of freedom; p stays 0.002.
    path = results.identification("noise.json")
    write_json(path, {**read_json(path), "chi2": 19.8})
    (text,) = (t for t in told(study, facts_in(study, results)) if t.startswith(beginning))
    assert text.startswith("Chi-square per point, 1.1, says only that the residuals are as large")
    assert text.endswith(
        "Judge the model by the test; use chi-square to compare fits of the same tests."
    )


def told(study: Study, facts: Facts) -> tuple[str, ...]:
    """Return the answers to the first question."""
    return summary(study, facts)[0].said


def test_assumptions_are_told_with_their_part_in_the_signals(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = facts_in(study, results)
    influence = {"change of h at the front": 0.124, "initial temperature": 0.01}
    said = summary(study, replace(facts, influence=influence))[1].said[-1]
    assert said.endswith(
        "Their largest parts in the variance of a signal: change of h at the front 12 %."
    )
    said = summary(study, replace(facts, influence={"initial temperature": 0.01}))[1].said[-1]
    assert said.endswith("None makes more than 5 % of the variance of a signal.")


def test_best_predicting_set_has_the_least_mean_logarithm_of_the_errors(tmp_path: Path) -> None:
    facts = facts_in(*fake(tmp_path))
    by_set: dict[tuple[str, str], float] = {}
    for score in facts.scores:
        if score.use == "held out" and score.found_by not in ("published", "estimates"):
            key = (score.cost_function, score.found_by)
            by_set[key] = by_set.get(key, 1.0) * score.value
    chosen = best_predicting(facts.scores)
    assert chosen is not None
    assert (chosen.cost_function, chosen.found_by) == min(by_set, key=lambda one: by_set[one])
    worse = [replace(s, value=1e3 * s.value) if s in chosen.scores else s for s in facts.scores]
    other = best_predicting(worse)
    assert other is not None
    assert (other.cost_function, other.found_by) != (chosen.cost_function, chosen.found_by)


def test_first_screen_has_a_figure_and_the_answer_and_other_tables_are_folded(
    tmp_path: Path,
) -> None:
    _, text = written(tmp_path)
    top, rest = text.split('<section id="data">')
    assert "The answer: values, 95 % intervals and verdicts" in top
    assert "least squares" not in re.sub(r'<p class="note">.*?</p>', "", top)
    assert top.count("<figure ") == 1
    assert rest.count("<table") > 10
    outside = unfolded(rest)
    assert "<table" not in outside
    assert "<figure " in outside


def unfolded(text: str) -> str:
    """Return a page without what is folded; details may lie in details."""
    kept, depth = [], 0
    for piece in re.split(r"(<details[^>]*>|</details>)", text):
        if piece.startswith("<details"):
            depth += 1
        elif piece == "</details>":
            depth -= 1
        elif depth == 0:
            kept.append(piece)
    return "".join(kept)


def test_answer_by_hand(tmp_path: Path) -> None:
    table = made("answer", *fake(tmp_path)).set_index("parameter")
    k, cp = table.loc["k"], table.loc["cp"]
    assert k[["fit", "unit"]].tolist() == ["inverse modelling", "W/(m K)"]
    assert k[["estimate", "low", "high", "verdict"]].tolist() == [0.3, 0.28, 0.32, "determined"]
    # J become kJ.
    assert cp["estimate"] == 3.5
    assert cp["verdict"] == "at its upper limit; undetermined"
    assert [column for column in table if "(" in column] == []


def test_parameter_of_both_stages_has_the_value_of_the_last_one(tmp_path: Path) -> None:
    given = described()
    given["imp"]["estimate"] = ["k", "cp", "T_p"]
    study = as_study(given, "fake.json")
    _, results = fake(tmp_path)
    (first,) = estimated_of(study, results, "kinetics")
    again = replace(first, stage="imp", value=605.0)
    assert one_each(study, [first, again]) == [again]


def estimated_of(study: Study, results: Results, stage: str) -> list[Estimated]:
    """Return the estimates of a stage of the fake study."""
    alone = as_study(described(), "fake.json")
    return [e for e in estimates_of(alone, identification.read(alone, results)) if e.stage == stage]


def test_best_sets_by_hand(tmp_path: Path) -> None:
    table = made("best_sets", *fake(tmp_path)).set_index("parameter")
    # Least squares has the lowest costs; k is at its upper limit of 0.5; J become kJ.
    ours = ["RMSE (least squares)", "BANDS (least squares)"]
    assert [column for column in table if "(" in column] == ours
    assert table.loc["k", ours].tolist() == [0.5, 0.5]
    assert table.loc["cp", ours].tolist() == [1.5, 1.5]
    assert table["at_limit"].fillna("").to_dict() == {"k": "RMSE, BANDS", "cp": ""}
    # 0.28 to 0.32, and 1.4 to 3.5.
    assert table["outside"].fillna("").to_dict() == {"k": "RMSE, BANDS", "cp": ""}


@pytest.mark.parametrize("factor", [1.9, 2.1])
def test_estimates_that_predict_worse_than_they_fit_are_told(tmp_path: Path, factor: float) -> None:
    study, results = fake(tmp_path)
    scores = read_csv(results.validation("scores.csv"))
    scores.loc[scores["experiment"] == "slab_60", "cv_rmse"] *= factor
    write_csv(results.validation("scores.csv"), scores)
    facts = facts_in(study, results)
    said = (
        "Held-out tests: the error of the mass loss rate is more than twice that of the fitted "
        "data. Expect such errors of other tests, too."
    )
    assert (said in summary(study, facts)[0].said) == (factor > 2.0)
    assert ("Find first why they are worse" in advice(study, facts)) == (factor > 2.0)


def test_other_kinetics_of_the_inverse_modelling_are_told(tmp_path: Path) -> None:
    given = described()
    given["imp"]["kinetics"] = "book"
    said = summary(*_with_facts(tmp_path, given))[1].said
    assert any("takes the kinetics 'book' of the study, not the estimated" in t for t in said)
    assert not any("takes the kinetics" in t for t in summary(*_with_facts(tmp_path))[1].said)


def _with_facts(folder: Path, given: dict[str, Any] | None = None) -> tuple[Study, Facts]:
    study, results = fake(folder, given)
    return study, facts_in(study, results)


def test_limits_come_first_among_the_values(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    path = results.identification("estimate.csv")
    bound = read_csv(path).assign(verdict="at its upper limit", bound="upper")
    write_csv(path, bound)
    said = summary(study, facts_in(study, results))[1].said
    assert said[0].startswith("k (upper) and cp (upper) are at a limit: the best fit lies outside")


def test_fitted_tests_in_air_are_told_among_the_values(tmp_path: Path) -> None:
    given = described()
    for name in ("fast", "slow"):  # no cost compares the fast one
        given["experiments"][name]["gas"] = "air"
    study, facts = _with_facts(tmp_path, given)
    said = [one for one in summary(study, facts)[1].said if "no oxidation" in one]
    assert [one.split(":")[0] for one in said] == ["slow"]
    assert ": the gas is air, and the model has no oxidation." in said[0]


def test_sections_say_the_numbers(tmp_path: Path) -> None:
    page, _ = written(tmp_path)
    for claim in (
        "2 parameters fitted to Slab 25 kW/m², with 2 cost functions and 3 repetitions each; held "
        "out: slab_60.",
        "fitted to 1 of 2 heating rates, miss the mass fraction there by 0.0200 (RMSE), "
        "and by 0.0100 at the others.",
        "The published set 'book' misses it by 2.01 to 2.02 at all rates.",
        "0.1 for RMSE (published 0.1) and 0.1 for BANDS.",
        "RMSE by 20 %, 1 of 2 starts of least squares agree (k at a limit); BANDS by 20 %, 1 of "
        "2 starts of least squares agree (k at a limit). SCE-UA stopped at a local optimum for "
        "RMSE. SCE-UA had not converged for BANDS: least squares from its "
        "best set finds a lower cost.",
        "at a limit: k (RMSE, BANDS); scattered (spread above 20 % of the search range): cp",
        "with CV(RMSE) 0.450 (fitted data: CV(RMSE) 0.450).",
        "The estimates predict the back temperature of slab_60 with RMSE 7.20 K.",
        "The best set of RMSE (least squares) lies outside the interval of k (0.5 against 0.28 to "
        "0.32 W/(m K)). This tells about the cost function; it is no second answer.",
        "Of 6 sets of searches, that of RMSE (SCE-UA) predicts the held-out tests best: the mass "
        "loss rate with CV(RMSE) 0.250 and the back temperature with RMSE 7.00 K.",
        "By the data (width of the 95 % interval, % of the search range): of the kinetics "
        "determined T_p (10.0 %); of the inverse modelling determined k (10.0 %), undetermined cp "
        "(70.0 %, upper limit).",
    ):
        assert claim in page.words
    assert "Slab 25 kW/m²: released 4.000 of " in page.words
    assert "Measured data from 2 files" in " ".join(page.words.split())


def test_measured_series_have_use_range_and_uncertainty(tmp_path: Path) -> None:
    _, text = written(tmp_path)
    rows = re.findall(r"<tr>(.*?)</tr>", text.split('id="data"')[1], re.S)
    cells = [re.findall(r"<td[^>]*>(.*?)</td>", row, re.S)[:7] for row in rows[1:7]]
    # 0.1 g/(m² s) for each second from 5 to 100 s; 500 to 700 K.
    tga = ["mass fraction", "kinetics, fitted", "41", "227 to 427 °C"]
    assert cells[1][:5] == ["slow", *tga]
    assert [row[2] for row in cells[:3]] == ["kinetics, compared", "kinetics, fitted", "not used"]
    values = ["20", "5 to 100 s", "0.5 to 10 g/(m² s)", "± 0.2 g/(m² s)"]
    assert cells[3] == ["Slab 25 kW/m²", "mass loss rate", "fitted", *values]
    warm = ["20", "5 to 100 s", "31.9 to 127 °C", "not stated"]
    assert cells[5] == ["slab_60", "back temperature", "held out", *warm]


def test_titles_name_their_place_in_the_paper_only_beside_published_values(tmp_path: Path) -> None:
    page, _ = written(tmp_path / "published")
    place = "over the repetitions (Table 4 of Lauer et al., 2020)"
    assert place in page.words
    page, _ = written(tmp_path / "own", synthetic())
    assert "Best set, mean and standard deviation over the repetitions (synthetic" in page.words
    assert not re.search(r"(Table|Figure) \d", re.sub(r"Table 3, and W", "", page.words))


def test_rows_and_bodies_of_a_cost_function_are_marked(tmp_path: Path) -> None:
    _, text = written(tmp_path)
    assert 'data-costs="[&#34;RMSE&#34;, &#34;BANDS&#34;]"' in text
    body = text.split('<div data-cost="BANDS">')[1]
    assert "<h4>BANDS</h4>" in body[:30]
    assert re.search(r'<tr data-cost="BANDS"><td class="s">BANDS</td>', text)


def test_robustness_is_shown_once_it_has_run(tmp_path: Path) -> None:
    page, _ = written(tmp_path)
    assert "robustness" not in page.ids
    study, results = fake(tmp_path)
    for cost in study.imp.costs:
        about = {
            "cost_function": cost,
            "kind": "noise",
            "level": min(study.options(RobustnessOptions).noise),
        }
        twin = {"draw": 0, "cost": 0.1, "calls": 10, "prediction_error": 0.01, "k": 0.4, "cp": 2e3}
        write_csv(results.of_step("robustness", f"{cost}.csv"), pd.DataFrame([{**about, **twin}]))
        write_options(study, results, "robustness", cost)
    frame = ROBUSTNESS.make(study, results)
    write_table(results.folder("robustness"), "table", ROBUSTNESS, frame, study)
    write_text(results.of_step("robustness", "robustness.svg"), "<svg/>")
    write_text(results.of_step("robustness", "robustness.png"), "")
    write_report(study, results)
    page = Page((tmp_path / "report.html").read_text())
    assert "robustness" in page.ids
    assert "Median error of the parameters in per cent of their limits" in page.words


def test_scores_under_other_costs_are_shown_once_they_are_there(tmp_path: Path) -> None:
    page, _ = written(tmp_path)
    assert "rescore" not in page.ids
    study, results = fake(tmp_path)
    at = {"low": 0.2, "high": 0.4, "best": 0.3}
    found = {
        "signals": ["slab_25 mlr"],
        "tells_apart": True,
        "value": 0.1,
        "set_number": 3,
        "fitted_with": "RMSE",
        "parameters": {"k": 0.2, "cp": 2000.0},
        "valley_sets": 1,
        "valley": {"k": at, "cp": at},
    }
    counts = {"stored": 900, "failed": 2, "sampled": 60, "histories": 6, "unfinished": 0}
    content = {
        "study": study.name,
        **counts,
        "drift": 0.01,
        "valley_share": 0.01,
        "left_out": ["no GPYRO"],
        "same": [],
        "measures": [{"name": name, "words": "a cost", **found} for name in ("RMSE", "GPYRO")],
    }
    rescored.write(results, rescored.Rescored.model_validate(content))
    write_options(study, results, "rescore")
    matrix = pd.DataFrame({"cost": ["RMSE", "GPYRO"], "RMSE": [1.0, 0.5], "GPYRO": [0.5, 1.0]})
    for name in ("CORRELATION", "AMONG_BEST", "EXCESS", "BETTER"):
        write_csv(results.of_step("rescore", getattr(rescored, name)), matrix)
    RESCORE.write(study, results)
    write_report(study, results)
    page = Page((tmp_path / "report.html").read_text())
    assert {"rescore", "rescore_agreement", "rescore_valleys"} <= set(page.ids)
    for words in (
        "60 of 900 stored model calls from 6 searches were scored under 2 costs.",
        "RMSE and GPYRO rank them unlike each other.",
        "RMSE and GPYRO agree least (rank correlation 0.50).",
        "overlap in every parameter",
        "Stored and recomputed costs differ by up to 1\xa0%",
        "Left out: no GPYRO",
        "kJ/(kg K)",
    ):
        assert words in page.words, words


def test_ensemble_is_recommended_once_it_is_there_and_has_converged(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    write_tables(study, results)
    for converged, words in ((True, "ensemble of 100 sets"), (False, "use all estimates together")):
        write_posterior(study, results, converged)
        said = advice(study, facts_of(study, results, tables_of(study, results)))
        assert words in said
        assert "the estimates predict the mass loss rate" in said
        assert ("ensemble" in said) == converged


def write_posterior(study: Study, results: Results, converged: bool) -> None:
    """Write a posterior of two parameters that predicts nothing."""
    of = dict.fromkeys(("mean", "sd", "low", "median", "high", "rhat", "ess"), 1.0)
    counts = ("seed", "ensembles", "walkers", "steps", "left_out", "calls", "chi2", "freedom")
    lacking = dict.fromkeys(("level", "time", "offset", "lasting"), 0.1)
    content = {
        "study": study.name,
        **dict.fromkeys((*counts, "probability", "accepted", "times"), 1),
        "converged": converged,
        "sets": 100,
        "parameters": [{"name": name, **of} for name in study.imp.estimate],
        "discrepancies": [{"experiment": "slab_25", "signal": "mlr", **lacking}],
        "bands": [],
    }
    posterior.write(results, posterior.SampledPosterior.model_validate(content))
    write_text(results.of_step("posterior", "parameters.svg"), "<svg/>")


def test_synthetic_data_are_said_so(tmp_path: Path) -> None:
    page, _ = written(tmp_path, synthetic())
    assert "Synthetic data." in page.words
    assert "Measured data from" not in page.words
    study, _ = fake(tmp_path, synthetic())
    shown = [n for n, item in {**FIGURES, **TABLES}.items() if item.applies(study)]
    assert page.words.count("(synthetic data)") == len(shown)


def test_truth_stands_beside_the_estimates_where_it_is_known(tmp_path: Path) -> None:
    page, _ = written(tmp_path, synthetic())
    assert "truth" in page.ids
    # By hand: (0.4985 - 0.2)/0.4 and (1.0 - 1.5)/3; (0.5 - 0.2)/0.4 and 0; (605 - 600)/100.
    for claim in (
        "best sets of SCE-UA, largest per fit, in per cent of the search range: 75 % in k, at "
        "most 17 % in the others (RMSE); "
        "75 % in k, at most 17 % in the others (BANDS).",
        "best sets of least squares, largest per fit, in per cent of the search range: 75 % in k, "
        "at most 0 % in the others",
        "The kinetics are off by: 5 % in T_p (SCE-UA); 1 % in T_p (least squares).",
    ):
        assert claim in page.words


def test_section_on_the_truth_is_for_synthetic_data_alone(tmp_path: Path) -> None:
    page, _ = written(tmp_path)
    assert "truth" not in page.ids
    assert "synthetic" not in page.words


def test_sentences_on_kinetics_alone_say_nothing_of_costs() -> None:
    errors = {"sceua_error_limits_percent": [2.0], "least_squares_error_limits_percent": [-1.0]}
    table = pd.DataFrame({"fit": "kinetics", "parameter": ["T_p"], **errors})
    assert sentences(table) == [
        "The kinetics are off by: 2 % in T_p (SCE-UA); 1 % in T_p (least squares)."
    ]


def test_study_without_kinetics_and_published_values_has_a_report(tmp_path: Path) -> None:
    given = described(kinetics=None)
    given["imp"]["kinetics"] = "described"
    given["parameters"]["T_p"]["value"] = 600
    del given["published"]
    page, _ = written(tmp_path, given)
    assert "kinetics" not in page.ids
    assert "published" not in page.words


def test_section_on_what_the_data_determine_says_correlation_misfit_and_optimisers(
    tmp_path: Path,
) -> None:
    page, _ = written(tmp_path)
    for claim in (
        "The strongest correlation is that of k and cp, −0.80.",
        DESCRIBED,
        MISSED,
        "SCE-UA best 1.00 sd (chi-square 5.00); SCE-UA mean 2.00 sd (chi-square 10.0); least "
        "squares best 3.00 sd (chi-square 15.0); CMA-ES best 4.00 sd (chi-square 20.0).",
    ):
        assert claim in page.words


def test_text_of_the_study_cannot_become_markup(tmp_path: Path) -> None:
    _, text = written(tmp_path, described(title="<script>alert(1)</script>"))
    assert "<script>alert" not in text
    assert "&lt;script&gt;alert(1)" in text


def test_provenance_names_what_the_results_rest_on(tmp_path: Path) -> None:
    written(tmp_path)
    first = (tmp_path / "provenance.json").read_bytes()
    origin = json.loads(first)
    assert origin["data"]["slab_60/mlr"] == {"source": "slab.csv", "sha256": "ab12"}
    assert {"config_digest", "seed", "packages", "source_fingerprint"} <= set(origin)
    page, _ = written(tmp_path)
    assert (tmp_path / "provenance.json").read_bytes() == first
    assert origin["config_digest"] in page.words


def test_missing_figure_is_named(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    write_tables(study, results)
    with pytest.raises(DataError, match=r"overview\.svg: cannot be read"):
        write_report(study, results)


def test_likely_error_of_the_data_is_the_first_next_step(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = replace(facts_in(study, results), suspect="the flux of slab_25 is 10 times too large")
    first = next(next_steps(study, facts))
    assert first.startswith("Look at the data first")
    assert first.endswith("the flux of slab_25 is 10 times too large.")


def test_cause_that_a_fit_refutes_is_no_next_step(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = facts_in(study, results)
    (fitted,) = {s.experiment for s in facts.goodness["kinetics"].signals}
    causes = [
        preview.Likely(
            cause="clock", places=[place], words=f"clock of {place}", explained=0.9, left=0.01
        )
        for place in (fitted, "slab_60")
    ]
    found = preview.Preview(
        sets=9, unfinished={}, windows=[], nearest=[], far=True, causes=causes, unmoved=[]
    )
    preview.write(results, found)
    results.of_step("preview", INPUTS.files[-1]).touch()
    assert facts_in(study, results).suspect == "clock of slab_60"
    assert facts.goodness["kinetics"].describes


def test_share_of_0_is_told_as_such(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = facts_in(study, results)
    share = Parameter(unit="-", lower=0.0, upper=0.1)
    study = study.model_copy(update={"parameters": {**study.parameters, "cp": share}})
    estimates = [replace(e, bound="lower") if e.name == "cp" else e for e in facts.estimates]
    said = list(next_steps(study, replace(facts, estimates=estimates)))
    assert said[0].startswith("cp: the data show a share of 0")
    assert not any("no material" in one or "Widen" in one for one in said)


def test_energy_of_one_heating_rate_is_not_to_be_published(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = facts_in(study, results)
    estimates = [
        replace(e, verdict=ONE_RATE, bound="") if e.name == "cp" else e for e in facts.estimates
    ]
    _, publish, then = summary(study, replace(facts, estimates=estimates))
    (said,) = (text for text in publish.said if text.startswith("The tests have one heating rate"))
    assert "cp follows from the order" in said
    assert any("Rests on one heating rate: cp" in t for t in publish.said)
    assert "To determine cp, measure at three heating rates or more." in then.said


def test_water_that_the_model_lacks_is_the_first_next_step(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = replace(facts_in(study, results), water="The model has no water.")
    assert next(next_steps(study, facts)) == "The model has no water."


def test_reactions_that_are_offered_stand_among_the_next_steps(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    facts = replace(facts_in(study, results), offers=["Two reactions predict better."])
    said = list(next_steps(study, facts))
    assert "Two reactions predict better." in said
    assert said.index("Two reactions predict better.") < len(said) - 1
