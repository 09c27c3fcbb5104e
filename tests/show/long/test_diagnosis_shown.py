"""Tables, figures and page of a diagnosis, from hand-made results of every kind of verdict."""

import json
import re
from itertools import pairwise
from pathlib import Path
from typing import Any, get_args

import pandas as pd
import pytest
from diagnosis_made import EFFECTS, EFFECTS_OF, curves, diagnosed, found, profile_of
from report_pages import Page, write_tables
from shown_studies import described, synthetic

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.errors import DataError
from pyrofit.results.diagnosis import read
from pyrofit.results.diagnosis import read_curves as curves_of
from pyrofit.results.diagnosis_candidates import OfCandidate
from pyrofit.results.diagnosis_schema import Diagnosis, Kind, OfVerdict
from pyrofit.results.files import Results, write_csv, write_json, write_text
from pyrofit.results.schema_page import schema_page
from pyrofit.show import diagnosis_page as report
from pyrofit.show import style
from pyrofit.show.diagnosis.curves import pairs_of_axes as signal_pairs
from pyrofit.show.diagnosis.sentences import gap_closed
from pyrofit.show.diagnosis.words import leading, prediction_name, ranked
from pyrofit.show.diagnosis_page import (
    PAGE,
    draw_all,
    page_of_diagnosis,
    write_diagnosis_tables,
)
from pyrofit.show.report import write_report
from pyrofit.show.sections import FIGURES

KINDS = get_args(Kind)


def table(root: Path, kind: str, name: str) -> pd.DataFrame:
    study, results = diagnosed(root, kind)
    return PAGE.frames(study, results)[name]


# Tables


def test_values_and_units_of_the_gap_are_those_a_person_works_out(tmp_path: Path) -> None:
    gap = table(tmp_path, "named", "gap").set_index(["experiment", "signal"])
    rate = gap.loc[("Slab 25 kW/m²", "mass loss rate")]
    # 4 sd of 3e-4 kg/(m2 s), and 1; chi-square 25 per point.
    assert rate["rms_before"] == pytest.approx(1.2)
    assert rate["rms_after"] == pytest.approx(0.3)
    assert rate["unit"] == "g/(m² s)"
    assert rate["closed_percent"] == pytest.approx(75.0)
    assert (rate["before_sd"], rate["after_sd"]) == (5.0, 1.0)
    back = gap.loc[("slab_60", "back temperature")]
    assert (back["role"], back["rms_before"], back["unit"]) == ("held out", 4.0, "K")


def test_errors_that_rise_count_only_where_a_signal_can_tell(tmp_path: Path) -> None:
    study, _ = diagnosed(tmp_path, "named")
    content = found(study, "named")
    rate, back = (g for g in content["gap"] if g["experiment"] == "slab_60")
    rate |= {"role": "held out", "tells": True}
    back["tells"] = False
    rate["rms_after"], back["rms_after"] = 0.5 * rate["rms_before"], 2.0 * back["rms_before"]
    said = gap_closed(Diagnosis.model_validate(content))
    assert "rises with the effects for 0 of 1 held-out signals that can tell" in said
    assert "signals that cannot tell: 1, of these 1 with a larger error" in said
    assert "log score" not in said
    rate["rms_after"] = 2.0 * rate["rms_before"]
    assert "for 1 of 1 held-out signals that can tell" in gap_closed(
        Diagnosis.model_validate(content)
    )
    content["verdict"]["effects"] = []
    assert "held-out signals" not in gap_closed(Diagnosis.model_validate(content))


@pytest.mark.parametrize("kind", ["none", "unknown"])
def test_without_named_effects_there_is_no_after(kind: str, tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, kind)
    frames = PAGE.frames(study, results)
    assert not {"rms_after", "after_sd", "closed_percent"} & set(frames["gap"])
    assert "extended" not in frames["parameters"]
    assert "strengths" not in frames


def test_windows_say_where_and_how_far(tmp_path: Path) -> None:
    frame = table(tmp_path, "named", "windows")
    assert list(frame["model"].unique()) == ["base model", "with the effects found"]
    first = frame.iloc[0]
    assert (first["phase"], first["time_s"]) == ("heat-up", "5 to 60")
    assert first["difference"] == "-0.6 g/(m² s)"
    assert first["relative_percent"] == pytest.approx(-12.0)
    assert first["temperature_C"] == "127 to 227"
    assert frame.iloc[-1]["temperature_C"] == "347 to 407"


def test_candidates_are_ranked_and_say_why_they_were_rejected(tmp_path: Path) -> None:
    frame = table(tmp_path, "named", "candidates")
    assert list(frame["above_best"]) == sorted(frame["above_best"])
    best = frame.iloc[0]
    assert (best["model"], best["gain"], best["remark"]) == (
        "slope of the conductivity (k_T)",
        1650.0,
        "in the verdict",
    )
    # The interval is that with the form's uncertainty.
    assert "-0.00123 (-0.005 to 0.004) 1/K" in best["fitted"]
    assert best["predictions"] == "slab_60 +12.0; all held-out tests -1.5"
    assert set(frame["remark"][1:]) == {"chi-square is 1500 above that of the best"}


def test_what_was_not_rejected_is_only_in_a_verdict_that_claims_it(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "named")
    altered(results, "verdict.kind", "unknown")
    assert PAGE.frames(study, results)["candidates"]["remark"][0] == "not claimed"


def test_strengths_have_both_intervals(tmp_path: Path) -> None:
    frame = table(tmp_path, "multiple", "strengths")
    assert list(frame["effect"]) == ["slope of the conductivity (k_T)", "melting"]
    row = frame.iloc[0]
    assert row[["low_wide", "high_wide"]].tolist() == [-0.005, 0.004]
    assert row[["low", "high"]].tolist() == [profile_of("k_T")["low"], profile_of("k_T")["high"]]


def test_parameters_stand_beside_those_with_the_effects(tmp_path: Path) -> None:
    frame = table(tmp_path, "named", "parameters").set_index("parameter")
    assert frame.loc["k", ["base", "extended"]].tolist() == [0.25, 0.31]
    assert frame["at_limit"].tolist() == ["", "yes"]


def test_tables_are_written_and_those_of_an_earlier_diagnosis_removed(tmp_path: Path) -> None:
    write_diagnosis_tables(*diagnosed(tmp_path, "unknown"))
    folder = tmp_path / "diagnosis" / "tables"
    assert (folder / "probes.md").exists()
    write_diagnosis_tables(*diagnosed(tmp_path, "named"))
    assert {p.stem for p in folder.glob("*.csv")} == set(report.TABLES) - {
        "probes",
        "next_experiments",
        "taken_away",
    }
    assert not (folder / "probes.md").exists()


# Figures


@pytest.mark.parametrize("kind", KINDS)
def test_every_figure_there_is_is_drawn(kind: str, tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, kind)
    wanted = {"mass_loss_rate", "back_temperature", "mass_fraction", "effects", "ranking"}
    wanted |= {"probes"} if kind == "unknown" else set()
    wanted |= {"next_experiments"} if kind == "ambiguous" else set()
    wanted |= {"profiles"} if EFFECTS_OF[kind] else set()
    assert set(draw_all(results, study)) == wanted
    folder = tmp_path / "diagnosis"
    assert {p.stem for p in folder.glob("*.png")} == wanted
    assert all((folder / f"{name}.png").stat().st_size > 5000 for name in wanted)


@pytest.mark.parametrize("kind", ["ambiguous", "unknown"])
def test_figures_are_drawn_alike_each_time(kind: str, tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, kind)
    names = draw_all(results, study)
    first = {name: results.diagnosis(f"{name}.svg").read_bytes() for name in names}
    draw_all(results, study)
    assert {name: results.diagnosis(f"{name}.svg").read_bytes() for name in names} == first


def test_candidates_of_three_effects_stay_on_the_canvas(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "unknown")
    path = results.diagnosis("diagnosis.json")
    found = json.loads(path.read_text())
    forms = {"glass_transition": "temperature_K", "emissivity_conversion": "", "melting": "width_K"}
    others = sorted(set(known_effects()) - set(forms))
    for candidate, other in zip(found["candidates"], others, strict=False):
        candidate["effects"] = [*forms, other]
        candidate["free"] = {e: ["strength", *filter(None, [form])] for e, form in forms.items()}
        candidate["rejected"] = "emissivity_conversion: predictions do not improve, " * 4
    write_json(path, found)
    with style.style():
        canvas = report.FIGURES["ranking"].make(study, results)
        canvas.draw_without_rendering()
        (ax,) = canvas.axes
        extents = [text.get_window_extent() for text in (*ax.get_yticklabels(), *ax.texts)]
    assert len(extents) == 2 * len(found["candidates"])
    width = canvas.bbox.width
    assert ax.get_window_extent().width > 0.3 * width
    assert all(0.0 <= extent.x0 < extent.x1 <= width for extent in extents)
    # Names do not run into each other.
    names = sorted(extents[: len(found["candidates"])], key=lambda extent: -extent.y1)
    assert all(above.y0 >= below.y1 for above, below in pairwise(names))


def test_figures_of_an_earlier_diagnosis_are_removed(tmp_path: Path) -> None:
    rectangles(*diagnosed(tmp_path, "unknown"))
    study, results = diagnosed(tmp_path, "none")
    assert results.diagnosis("probes.svg").exists()
    draw_all(results, study)
    assert not results.diagnosis("probes.svg").exists()


def words_of(results: Results, name: str) -> list[str]:
    """Return the texts of a figure: drawn as paths, the SVG keeps them as comments."""
    text = results.diagnosis(f"{name}.svg").read_text()
    return re.findall(r"<!-- (.*?) -->", text)


def test_named_windows_and_held_out_signals_are_labelled(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "named")
    draw_all(results, study)
    said = words_of(results, "mass_loss_rate")
    # Neighbours of one phase carry one label; windows of the extended model carry none.
    assert [said.count(p) for p in ("heat-up", "onset", "plateau", "tail")] == [1, 1, 1, 1]
    assert "with the effects found" in said
    assert "slab_60, held out" in words_of(results, "back_temperature")


def test_rejected_candidates_carry_their_reason(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "ambiguous")
    draw_all(results, study)
    said = words_of(results, "ranking")
    assert said.count("in the verdict") == 3  # two candidates and the legend
    assert said.count("chi-square is 1500 above that of the best") == len(EFFECTS) + 2 - 3
    assert "melting (T_m)" in said
    assert "melting" not in said  # the other fit of this effect is worse


def test_synthetic_data_are_named_in_every_title(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "named", synthetic())
    for name in draw_all(results, study):
        assert "(synthetic data) -->" in results.diagnosis(f"{name}.svg").read_text()


def test_a_probe_is_a_factor_or_a_change_with_a_unit(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "unknown")
    draw_all(results, study)
    said = words_of(results, "probes")
    assert "factor on the flux" in said
    assert "change of the front heat loss" in said
    assert {"[–]", "[kW/m²]"} <= set(said)


# Page


def rectangles(study: Study, results: Results) -> None:
    """Write a rectangle for each figure of the diagnosis."""
    for name in page_of_diagnosis(study, read(study, results)).figures:
        write_text(results.diagnosis(f"{name}.svg"), '<svg width="240.95pt"><rect/></svg>')


def page_of(root: Path, kind: str) -> tuple[Page, str]:
    study, results = diagnosed(root, kind)
    rectangles(study, results)
    report.write_page(study, results)
    text = results.diagnosis("report.html").read_text().replace("\xa0", " ")
    return Page(text), text


@pytest.mark.parametrize("kind", KINDS)
def test_page_of_every_verdict_says_it_and_loads_nothing(kind: str, tmp_path: Path) -> None:
    page, text = page_of(tmp_path, kind)
    assert page.words.count(f"These are the words of {kind}.") == 1
    assert page.loads
    assert all(load.startswith(("data:image/svg+xml;base64,", "#")) for load in page.loads)
    assert "http" not in re.sub(r"base64,[A-Za-z0-9+/=]+", "", text)
    assert "nan" not in re.findall(r"\w+", page.words.casefold())
    assert "None" not in re.findall(r"\w+", page.words)
    command = "snakemake --cores 2 --configfile" in page.words
    assert command == bool(EFFECTS_OF[kind])


def test_page_says_what_was_not_tried_and_whose_noise_is_uncertain(tmp_path: Path) -> None:
    page, _ = page_of(tmp_path, "named")
    assert "(tga_lag)no calibrated signal can show it" in " ".join(page.words.split())
    assert (
        "No uncertainty is given, so that the noise is estimated: slow, mass fraction" in page.words
    )
    assert "less reliable: Slab 25 kW/m², mass loss rate" in page.words


def test_use_of_a_series_is_that_in_the_diagnosis(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "named")
    chosen = {"calibrate": {"slab_60": ("mlr",)}, "hold_out": {"slab_25": ("mlr",)}}
    study = study.model_copy(update={"diagnosis": study.diagnosis.model_copy(update=chosen)})
    rectangles(study, results)
    report.write_page(study, results)
    text = results.diagnosis("report.html").read_text().split('id="data"')[1].split("</table>")[0]
    rows = (re.findall(r"<td[^>]*>(.*?)</td>", row)[:3] for row in text.split("<tr>")[2:])
    uses = {(row[0], row[1]): row[2] for row in rows if len(row) == 3}
    assert uses["slab_60", "mass loss rate"] == "fitted"
    assert uses["Slab 25 kW/m²", "mass loss rate"] == "held out"
    assert uses["slab_60", "back temperature"] == "not used"
    assert uses["slow", "mass fraction"] == "kinetics, fitted"


def test_page_says_the_numbers(tmp_path: Path) -> None:
    page, _ = page_of(tmp_path, "named")
    words = " ".join(page.words.split())
    assert "Chi-square of the base model is 2000 on 320 points, above the critical" in words
    phases = "heat-up, onset, plateau, burn-out and tail"
    assert f"7 intervals have significant residuals of one sign: {phases}" in words
    assert known_effects()["k_T"].equation in words
    assert (
        "Chi-square falls from 2000 to 350 with slope of the conductivity (k_T). "
        "An effect must lower it by 12.4 to be claimed."
    ) in words
    assert "residuals goes from 5 to 1 (fitted) and from 5 to 1 (held out). Noise" in words
    assert "cp is at a limit" in words
    assert "slab_60 from the others +12.0 (of 14.0); all held-out tests -1.5 (cannot tell)" in words
    assert "The test of equal strengths needs a p above" in words


def test_predictions_are_named_by_title_and_laboratory(tmp_path: Path) -> None:
    study, _ = diagnosed(tmp_path, "named")
    study.experiments["slab_60"] = study.experiments["slab_60"].model_copy(
        update={"title": "Slab 60 kW/m²"}
    )
    names = {
        "slab_60": "Slab 60 kW/m²",
        "held out": "all held-out tests",
        "held out: slab_60": "held out: Slab 60 kW/m²",
        "held out: Aalto": "held out: Aalto",
    }
    assert {name: prediction_name(study, name) for name in names} == names


def test_page_of_an_ambiguous_verdict_says_what_to_measure(tmp_path: Path) -> None:
    page, _ = page_of(tmp_path, "ambiguous")
    words = " ".join(page.words.split())
    assert "best: gasification at 90 kW/m² with the back temperature; by 6.4 standard" in words


def test_report_shows_the_diagnosis_where_there_is_one(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "named")
    rectangles(study, results)
    for name, figure in FIGURES.items():
        if figure.applies(study):
            write_text(tmp_path / "figures" / f"{name}.svg", '<svg width="240.95pt"><rect/></svg>')
    write_tables(study, results)
    write_report(study, results)
    assert "diagnosis" not in Page((tmp_path / "report.html").read_text()).ids
    report.write_page(study, results)
    write_report(study, results)
    page = Page((tmp_path / "report.html").read_text())
    assert "diagnosis" in page.ids
    assert len(set(page.ids)) == len(page.ids)
    assert page.words.count("These are the words of named.") == 1


def test_page_without_drawn_figures_says_to_draw_them(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "named")
    with pytest.raises(DataError, match=r"mass_loss_rate\.svg: cannot be read .*; draw it first"):
        report.write_page(study, results)


# Broken results


def altered(results: Results, place: str, value: Any) -> None:
    path = results.diagnosis("diagnosis.json")
    content = json.loads(path.read_text())
    part: Any = content
    *keys, last = place.split(".")
    for key in keys:
        part = part[int(key) if key.isdigit() else key]
    part[last] = value
    write_json(path, content)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ("study", "other", "the diagnosis of another study"),
        ("noise.0.experiment", "gone", "the diagnosis of another study"),
        ("verdict.kind", "perhaps", r"'verdict\.kind' is 'perhaps', not one of 'none'"),
        ("verdict.sets", [], r"'verdict\.sets' is empty"),
        ("windows.0.phase", None, r"'windows\.0\.phase' is not text"),
        ("candidates.1.gain", "many", r"'candidates\.1\.gain' is not a finite number"),
        ("base.chi2", None, r"'base\.chi2' is not a finite number"),
    ],
)
def test_broken_diagnosis_is_refused_and_named(
    place: str, value: Any, message: str, tmp_path: Path
) -> None:
    study, results = diagnosed(tmp_path, "named")
    altered(results, place, value)
    with pytest.raises(DataError, match=message):
        read(study, results)


def test_diagnosis_with_a_key_that_the_schema_lacks_is_refused(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "named")
    altered(results, "base.more", 1.0)
    with pytest.raises(DataError, match=r"'base\.more' is not a key of this result"):
        read(study, results)


def test_page_of_the_schema_is_up_to_date() -> None:
    page = (Path(__file__).parents[3] / "docs" / "diagnosis_json.md").read_text(encoding="utf-8")
    assert page == schema_page(), "run: pyrofit reference --of diagnosis > docs/diagnosis_json.md"


def test_curves_that_lack_a_channel_are_refused(tmp_path: Path) -> None:
    study, results = diagnosed(tmp_path, "named")
    frame = curves(study, "named")
    write_csv(results.diagnosis("curves.csv"), frame[frame["experiment"] != "slow"])
    with pytest.raises(DataError, match="experiment 'slow', signal 'mass_fraction' is missing"):
        curves_of(study, results)


def test_leading_model_is_that_of_the_search_if_another_form_fits_better(tmp_path: Path) -> None:
    study, _ = diagnosed(tmp_path, "named", described())
    made = found(study, "named")
    candidates = [{**c, "adequate": c["adequate"] or None} for c in made["candidates"]]
    (end,) = [c for c in candidates if c["adequate"]]
    other = {**end, "adequate": None, "penalised": end["penalised"] - 5.0}
    other["free"] = {"k_T": [*end["free"]["k_T"], "another"]}
    end["rejected"] = "predictions do not improve"
    chosen = leading(Diagnosis.model_validate({**made, "candidates": [other, *candidates]}))
    assert chosen is not None
    assert chosen.rejected == "predictions do not improve"


def test_leading_candidate_is_the_best_that_was_not_rejected(tmp_path: Path) -> None:
    study, _ = diagnosed(tmp_path, "named", described())
    chosen = leading(Diagnosis.model_validate(found(study, "named")))
    assert chosen is not None
    assert (chosen.effects, chosen.rejected) == (["k_T"], "")
    assert leading(Diagnosis.model_validate(found(study, "unknown"))) is None


@pytest.mark.parametrize("signals", range(1, 20))
def test_each_signal_has_its_curve_above_its_residuals(signals: int) -> None:
    _, pairs = signal_pairs(signals)
    assert len(pairs) == signals
    for above, below in pairs:
        over, under = above.get_position(), below.get_position()
        assert over.x0 == under.x0
        assert over.y0 > under.y1


def test_every_figure_belongs_to_some_verdict(tmp_path: Path) -> None:
    shown = set()
    for kind in KINDS:
        study, results = diagnosed(tmp_path / kind, kind)
        shown |= set(page_of_diagnosis(study, read(study, results)).figures)
    curves = {"mass_loss_rate", "back_temperature", "mass_fraction"}
    assert shown == set(report.FIGURES) | curves


def test_model_of_the_verdict_is_shown_among_the_best() -> None:
    named = [("e0", "no"), ("e1", "no"), ("e2", "no"), ("e3", "no"), ("k_T", "")]
    rows = [
        OfCandidate.model_construct(
            effects=[effect], penalised=float(i), rejected=why, adequate=None if why else True
        )
        for i, (effect, why) in enumerate(named)
    ]
    verdict = OfVerdict.model_construct(effects=["k_T"])
    given = Diagnosis.model_construct(candidates=rows, verdict=verdict)
    assert [c.effects for c in ranked(given, 3)] == [["e0"], ["e1"], ["k_T"]]
    assert ranked(given) == ranked(given, 5) == rows


def test_tables_and_figures_have_places_of_their_own_below_their_sentences() -> None:
    items = [*report.TABLES.values(), *report.FIGURES.values()]
    places = [item.place for item in items]
    assert len(set(places)) == len(places)
    tables = {table.place for table in report.TABLES.values()}
    for hundred in report.PAGE.about:
        assert min(place for place in places if place // 100 == hundred // 100) in tables
