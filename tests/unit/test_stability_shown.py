"""Tables, figure, sentences and section of the stability of a diagnosis, from hand-made results."""

import json
from pathlib import Path
from typing import Any

import pytest
from test_diagnosis_shown import channels, diagnosed, gap_of
from test_report import Page, write_tables, written
from test_tables import described

from pyrofit.cli import main
from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.results import stability
from pyrofit.results.files import Results, write_text
from pyrofit.show import diagnosis_page, style
from pyrofit.show.report import write_report
from pyrofit.show.sections import FIGURES
from pyrofit.show.stability.facts import read
from pyrofit.show.stability.figures import draw
from pyrofit.show.stability.sentences import sentences
from pyrofit.show.stability_page import PAGE

VERDICTS: tuple[tuple[str, list[str], list[str]], ...] = (
    ("named", ["k_T"], ["k_T"]),
    ("multiple", ["k_T", "melting"], ["k_T", "melting"]),
    ("unknown", ["c_T"], ["c_T", "melting"]),
)


def with_draws(count: int = 3) -> dict[str, Any]:
    given = described()
    given["diagnosis"] = {**given.get("diagnosis", {}), "draws": count}
    return given


def of_draw(study: Study, number: int) -> dict[str, Any]:
    kind, effects, final = VERDICTS[number]
    strength = {"low": 0.0, "high": 1.0, "unit": "1/K", "low_form": None, "high_form": None}
    names = {"k_T": "slope_1_K", "c_T": "slope_1_K", "melting": "heat_J_kg"}
    return {
        "study": study.name,
        "origin": stability.origin(study),
        "draw": number,
        "disturbance": 0.1,
        "kind": kind,
        "confirmed": kind == "named",
        "effects": effects,
        "final": final,
        "chi2": 300.0,
        "strengths": {f"{e}_{names[e]}": {**strength, "value": 0.1 + number} for e in final},
        "gap": [gap_of(c, effects) for c in channels(study)],
    }


def stable_or_not(root: Path) -> tuple[Study, Results]:
    """Write a diagnosis and those of three disturbed data sets."""
    study, results = diagnosed(root, "named", with_draws())
    for number in range(3):
        stability.write(results, of_draw(study, number))
    return study, results


def test_effects_are_counted_by_verdict_and_by_final_model(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    frame = PAGE.tables["effects"].make(study, results).set_index("effect")
    assert [name.split("(")[-1].rstrip(")") for name in frame.index] == ["k_T", "melting", "c_T"]
    assert frame["measured"].tolist() == ["named", "–", "–"]
    assert frame["named_percent"].tolist() == pytest.approx([200 / 3, 100 / 3, 0.0])
    assert frame["final_percent"].tolist() == pytest.approx([200 / 3, 200 / 3, 100 / 3])
    assert (frame["lowest"].iloc[0], frame["highest"].iloc[0]) == (0.1, 1.1)


def test_each_draw_has_a_row_behind_the_measured_data(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    frame = PAGE.tables["draws"].make(study, results)
    assert frame["data"].tolist() == ["as measured", "draw 0", "draw 1", "draw 2"]
    assert frame["kind"].tolist() == ["named", "named", "multiple", "unknown"]
    assert frame["effects"].iloc[-1] == "–"  # `unknown` claims none
    assert frame["closed_percent"].tolist() == pytest.approx([75.0] * 4)


def test_sentences_tell_which_effects_depend_on_the_disturbance(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    said = " ".join(sentences(study, results))
    for words in (
        "repeated on 3 disturbed data sets: measured values plus 10 % of a draw of their noise.",
        "The verdict on the measured data is 'named'",
        "1 of 3 of them name exactly the same effects.",
        "depend on it: slope of the conductivity (k_T) (2 of 3).",
        "Named from disturbed data only:",
    ):
        assert words in said, (words, said)


def test_a_stable_result_is_said_to_be_stable(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    for number in (1, 2):
        stability.write(results, {**of_draw(study, 0), "draw": number})
    said = " ".join(sentences(study, results))
    assert "Named from all data sets: slope of the conductivity (k_T)." in said
    assert "depend on it" not in said
    assert "disturbed data only" not in said


def test_without_any_effect_there_is_a_table_and_an_empty_figure(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "none", with_draws())
    nothing = {"kind": "none", "confirmed": False, "effects": [], "final": [], "strengths": {}}
    for number in range(3):
        stability.write(results, {**of_draw(study, 0), **nothing, "draw": number})
    PAGE.draw_and_write(study, results)
    assert "3 of 3 of them name exactly the same effects." in " ".join(sentences(study, results))
    page = Page(section_text(study, results))
    assert "stability_stability" in page.ids


def section_text(study: Study, results: Results) -> str:
    """Return the report, with an empty figure for each of the other sections."""
    for name, figure in FIGURES.items():
        if figure.applies(study):
            write_text(results.root / "figures" / f"{name}.svg", '<svg width="24pt"><rect/></svg>')
    write_tables(study, results)
    write_report(study, results)
    return (results.root / "report.html").read_text()


def test_figure_has_a_bar_of_each_kind_for_each_effect(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    with style.style():
        (ax,) = draw(study, results).axes
    widths = [round(bar.get_width(), 1) for bar in ax.patches]  # type: ignore[attr-defined]
    assert widths == [66.7, 66.7, 33.3, 66.7, 33.3, 0.0]


def test_report_shows_the_stability_once_it_is_there(tmp_path: Path) -> None:
    page, _ = written(tmp_path, with_draws())
    assert "stability" not in page.ids
    study, results = stable_or_not(tmp_path)
    PAGE.draw_and_write(study, results)
    write_report(study, results)
    page = Page((tmp_path / "report.html").read_text())
    assert {"stability", "stability_stability"} <= set(page.ids)
    assert "1 of 3 of them name exactly the same effects." in page.words.replace("\xa0", " ")


def test_page_of_the_diagnosis_shows_the_stability_as_well(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    diagnosis_page.draw_all(results, study)
    diagnosis_page.write_page(study, results)
    assert "stability" not in Page(results.diagnosis("report.html").read_text()).ids
    PAGE.draw_and_write(study, results)
    diagnosis_page.write_page(study, results)
    page = Page(results.diagnosis("report.html").read_text())
    assert {"diagnosis", "stability", "stability_stability"} <= set(page.ids)


def test_report_leaves_out_the_stability_of_another_version_of_the_study(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    PAGE.draw_and_write(study, results)
    assert stability.is_current(study, results)
    stability.write(results, {**of_draw(study, 1), "origin": "before"})
    assert not stability.is_current(study, results)
    results.stability("draw_1.json").unlink()
    assert not stability.is_current(study, results)
    page = Page(section_text(study, results))
    assert "stability" not in page.ids


def test_missing_draw_names_the_file(tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    results.stability("draw_1.json").unlink()
    with pytest.raises(DataError, match=r"draw_1\.json"):
        read(study, results)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"study": "other"}, "this is the result of another study"),
        ({"kind": "sure"}, "'kind'"),
        ({"chi2": "many"}, "'chi2'"),
        ({"draw": 2}, "this is the result of another study"),
    ],
)
def test_broken_draw_names_file_and_key(change: dict[str, Any], words: str, tmp_path: Path) -> None:
    study, results = stable_or_not(tmp_path)
    path = results.stability("draw_1.json")
    path.write_text(json.dumps({**json.loads(path.read_text()), **change}))
    with pytest.raises(DataError, match="draw_1") as error:
        read(study, results)
    assert words in str(error.value)
    assert "delete it and run again" in str(error.value)


def test_command_refuses_a_draw_beyond_those_of_the_study(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "fake.json"
    path.write_text(json.dumps(with_draws()))
    command = ["stability", "--study", str(path), "--results", str(tmp_path), "--draw", "3"]
    assert main(command) == 2
    assert "has draws 0 to 2; raise diagnosis.draws for more" in capsys.readouterr().err
