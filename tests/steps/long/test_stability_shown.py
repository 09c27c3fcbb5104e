"""Tables, figure, sentences and section of the stability of a diagnosis, from hand-made results."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from diagnosis_made import diagnosed
from report_pages import Page, written
from shown_studies import described

from pyrofit.archive import result_files as archived
from pyrofit.cli import main
from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.results.files import Results, write_json
from pyrofit.show import diagnosis_page, style
from pyrofit.show.page import pages_of_steps
from pyrofit.show.report import write_report
from pyrofit.steps.stability import record as stability
from pyrofit.steps.stability.facts import read
from pyrofit.steps.stability.page import PAGE, draw_shares, sentences

REASON = "its strength is at a limit"
VERDICTS: tuple[tuple[str, list[list[str]], list[str]], ...] = (
    ("named", [["k_T"]], ["k_T"]),
    ("multiple", [["k_T"], ["melting"]], ["k_T", "melting"]),
    ("unknown", [["c_T"]], ["c_T", "melting"]),
)


def with_draws(count: int = 3) -> dict[str, Any]:
    given = described()
    given["steps"] = {"stability": {"draws": count}}
    return given


def of_draw(study: Study, results: Results, number: int, **changed: Any) -> stability.OfDraw:
    kind, sets, final = VERDICTS[number]
    content = {
        "study": study.name,
        "origin": stability.origin(study, results),
        "draw": number,
        "disturbance": 0.1,
        "kind": kind,
        "confirmed": kind == "named",
        "sets": sets,
        "reasons": [f"{final[0]}: {REASON}"],
        "final": final,
        "chi2": 300.0,
        "strengths": dict.fromkeys(final, 0.1 + number),
    }
    return stability.OfDraw(**{**content, **changed})


def stable_or_not(root: Path) -> tuple[Study, Results]:
    """Write a diagnosis and those of three disturbed data sets."""
    study, results = diagnosed(root, "named", with_draws())
    for number in range(3):
        stability.write(results, of_draw(study, results, number))
    return study, results


def test_effects_are_counted_by_verdict_and_by_final_model(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    frame = PAGE.tables["effects"].make(study, results).set_index("effect")
    assert [name.split("(")[-1].rstrip(")") for name in frame.index] == ["k_T", "melting", "c_T"]
    assert frame["measured"].tolist() == ["claimed", "–", "–"]
    assert frame["claimed_percent"].tolist() == pytest.approx([200 / 3, 100 / 3, 0.0])
    assert frame["final_percent"].tolist() == pytest.approx([200 / 3, 200 / 3, 100 / 3])
    assert (frame["lowest"].iloc[0], frame["highest"].iloc[0]) == (0.1, 1.1)


def test_each_draw_has_a_row_behind_the_measured_data(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    frame = PAGE.tables["draws"].make(study, results)
    assert frame["data"].tolist() == ["as measured", "draw 0", "draw 1", "draw 2"]
    assert frame["kind"].tolist() == ["named", "named", "multiple", "unknown"]
    assert frame["claimed"].tolist() == ["k_T", "k_T", "k_T, melting", "–"]
    assert frame["reasons"].tolist() == ["", "", "", f"c_T: {REASON}"]
    assert frame["final"].tolist()[1:] == ["k_T", "k_T, melting", "c_T, melting"]


def test_sentences_tell_which_effects_depend_on_the_disturbance(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    said = " ".join(sentences(study, results))
    for words in (
        "Random noise with 10 % of the estimated standard deviation was added to the data",
        "repeated: 3 times.",
        "Verdict on the measured data: 'named'. Verdicts on the disturbed data: 'named' (1),",
        "The same effects are claimed from 1 of 3 disturbed data sets.",
        "Not claimed from every disturbed data set: slope of the conductivity (k_T) (2 of 3).",
        "Named from disturbed data only:",
    ):
        assert words in said, (words, said)
    assert "Every search" not in said


def test_a_stable_result_is_said_to_be_stable(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    for number in (1, 2):
        stability.write(results, of_draw(study, results, 0, draw=number))
    said = " ".join(sentences(study, results))
    assert "Named from all data sets: slope of the conductivity (k_T)." in said
    assert "Every search ends with slope of the conductivity (k_T)." in said
    assert "Not claimed" not in said
    assert "disturbed data only" not in said


def test_without_any_effect_there_is_a_table_and_an_empty_figure(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "none", with_draws())
    nothing = {"kind": "none", "confirmed": False, "sets": [], "final": [], "strengths": {}}
    for number in range(3):
        stability.write(results, of_draw(study, results, 0, **nothing, draw=number))
    gathered(study, results)
    assert "No data set leads to a claimed effect." in " ".join(sentences(study, results))
    (page,) = pages_of_steps("diagnosis", study, results)
    shown = page.section(study, results)
    assert len(shown.parts) == 3


def test_figure_has_a_bar_of_each_kind_for_each_effect(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    with style.style():
        (ax,) = draw_shares(study, results).axes
    widths = [round(bar.get_width(), 1) for bar in ax.patches]  # type: ignore[attr-defined]
    assert widths == [66.7, 66.7, 33.3, 66.7, 33.3, 0.0]


def test_report_shows_the_stability_once_it_is_there(tmp_path: Path) -> None:
    page, _ = written(tmp_path, with_draws())
    assert "stability" not in page.ids
    study, results = stable_or_not(tmp_path)
    diagnosis_page.draw_all(results, study)
    diagnosis_page.write_page(study, results)
    gathered(study, results)
    write_report(study, results)
    page = Page((tmp_path / "report.html").read_text())
    assert {"stability", "stability_stability"} <= set(page.ids)
    assert "are claimed from 1 of 3 disturbed data sets." in page.words.replace("\xa0", " ")


def test_page_of_the_diagnosis_shows_the_stability_as_well(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    diagnosis_page.draw_all(results, study)
    diagnosis_page.write_page(study, results)
    assert "stability" not in Page(results.diagnosis("report.html").read_text()).ids
    gathered(study, results)
    diagnosis_page.write_page(study, results)
    page = Page(results.diagnosis("report.html").read_text())
    assert {"diagnosis", "stability", "stability_stability"} <= set(page.ids)


def gathered(study: Study, results: Results) -> None:
    """Do as the command that gathers all draws."""
    PAGE.write(study, results)


def of_data(study: Study, results: Results) -> None:
    path = results.measurement("slab_25", "mlr")
    path.write_text(path.read_text().replace("95.0", "95.5"))


def of_a_draw(study: Study, results: Results) -> None:
    stability.write(results, of_draw(study, results, 1, chi2=301.0))


def of_the_source(study: Study, results: Results) -> None:
    stability.write(results, of_draw(study, results, 1, origin="before"))


def of_the_diagnosis(study: Study, results: Results) -> None:
    path = results.diagnosis("diagnosis.json")
    found = json.loads(path.read_text())
    found["verdict"]["words"] = "Other words."
    path.write_text(json.dumps(found))


def no_draw(study: Study, results: Results) -> None:
    results.of_step("stability", "draw_1.json").unlink()


@pytest.mark.parametrize(
    "change",
    [of_data, of_a_draw, of_the_source, of_the_diagnosis, no_draw],
    ids=lambda f: f.__name__,
)
def test_pages_leave_out_a_stability_that_is_not_up_to_date(
    change: Callable[[Study, Results], None], tmp_path: Path
) -> None:
    study, results = stable_or_not(tmp_path)
    gathered(study, results)
    assert stability.version(study, results)
    change(study, results)
    assert stability.version(study, results) == ""
    assert pages_of_steps("diagnosis", study, results) == []


def test_fewer_draws_need_new_tables(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    gathered(study, results)
    fewer, _ = diagnosed(tmp_path, "named", with_draws(2))
    assert stability.version(fewer, results) == ""


def test_archive_has_the_draws_of_the_study_if_they_are_up_to_date(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    gathered(study, results)
    write_json(results.of_step("stability", "draw_7.json"), {"of": "more draws"})
    kept = {path.name for path in archived(study, results) if path.parent.name == "stability"}
    assert {"draw_0.json", "draw_2.json", "stability.json", "stability.svg"} <= kept
    assert "draw_7.json" not in kept
    of_a_draw(study, results)
    assert not any(path.parent.name == "stability" for path in archived(study, results))


def test_an_effect_counts_as_claimed_wherever_it_stands_in_a_set(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    for number, one in enumerate((["k_T", "c_T"], ["c_T", "k_T"], ["k_T", "c_T"])):
        draw = of_draw(study, results, 0, kind="ambiguous", sets=[one], draw=number)
        stability.write(results, draw)
    found = read(study, results)
    assert [found.times_claimed(effect) for effect in ("k_T", "c_T")] == [3, 3]


def test_missing_draw_names_the_file(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    results.of_step("stability", "draw_1.json").unlink()
    with pytest.raises(DataError, match=r"draw_1\.json"):
        read(study, results)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"origin": "before"}, "it was made from another version"),
        ({"kind": "sure"}, "'kind'"),
        ({"chi2": "many"}, "'chi2'"),
        ({"draw": 2}, "it was made from another version"),
    ],
)
def test_broken_draw_names_file_and_key(change: dict[str, Any], words: str, tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    path = results.of_step("stability", "draw_1.json")
    path.write_text(json.dumps({**json.loads(path.read_text()), **change}))
    with pytest.raises(DataError, match="draw_1") as error:
        read(study, results)
    assert words in str(error.value)
    assert re.search("run (`snakemake stability` )?again", str(error.value))


def test_command_refuses_a_draw_beyond_those_of_the_study(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "fake.json"
    path.write_text(json.dumps(with_draws()))
    command = ["stability", str(path), "--results", str(tmp_path), "--draw", "3"]
    assert main(command) == 2
    assert "has no draw '3'" in capsys.readouterr().err
