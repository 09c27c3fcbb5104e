"""The diagnosis as a section of a report and as a page of its own."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.parallel import parallel_map
from pyrofit.results import diagnosis, recorded
from pyrofit.results.diagnosis_schema import Diagnosis
from pyrofit.results.files import Results, write_text
from pyrofit.show.diagnosis import FIGURES, TABLES
from pyrofit.show.diagnosis.curves import curve_figures
from pyrofit.show.diagnosis.sentences import (
    certainty,
    facts,
    gap_closed,
    missing,
    next_measured,
    where_off,
)
from pyrofit.show.figure import Figure, draw_figure
from pyrofit.show.measured import use_in_diagnosis
from pyrofit.show.page import page_of
from pyrofit.show.parts import Part, Picture, Question, Shown, picture, table_part
from pyrofit.show.step_page import sections_of
from pyrofit.show.table import write_table

FOLDER = "diagnosis"


def exists(results: Results) -> bool:
    """Tell whether a study has been diagnosed and that is drawn: its page is written last."""
    return results.diagnosis("report.html").is_file()


def write_page(study: Study, results: Results) -> None:
    """Write ``diagnosis/report.html`` and the tables, from the results and the drawn figures.

    Raises
    ------
    DataError
        A result or a figure is missing.
    """
    make_diagnosis_tables(study, results)
    found = diagnosis.read(study, results)
    shown = section(study, results, found)
    title = f"{study.title or study.name}: diagnosis"
    measured = recorded.measured(study, results)
    said = [Question("", tuple(facts(found)))]
    parts = [shown, *sections_of("diagnosis", study, results)]
    text = page_of(study, measured, title, said, parts, use=use_in_diagnosis)
    write_text(results.diagnosis("report.html"), text)


def section(study: Study, results: Results, found: Diagnosis) -> Shown:
    """Return all that was found, in the order in which it is read."""
    tables, drawn = diagnosis_tables(study, results), figures_of(study, found)

    def parts(text: str, *names: str) -> list[Part | Picture]:
        """Return the tables and figures that there are, sentences before them."""
        made: list[Part | Picture] = []
        for name in names:
            if name in tables:
                made.append(table_part(study, TABLES[name], tables[name], text))
                text = ""
        if text:
            made.insert(0, Part(TABLES[names[0]].title, text=text))
        for name in names:
            if name in drawn:
                figure, path = drawn[name], results.diagnosis(f"{name}.svg")
                made.append(picture(path, f"diagnosis_{name}", figure.title, figure.caption))
        return made

    return Shown(
        "diagnosis",
        "Missing effects",
        "The misfit of the model, the effects that explain it, and the confidence in them.",
        (
            *parts(where_off(found), "windows", *(n for n in drawn if n not in FIGURES)),
            *parts(missing(found), "strengths", "profiles", "candidates", "ranking"),
            *parts("", "not_tried"),
            *parts("", "probes"),
            *parts(gap_closed(found), "gap"),
            *parts(certainty(study, found), "evidence", "taken_away", "accord", "kinetics_alone"),
            *parts("", "parameters", "noise", "effects"),
            *parts(next_measured(found), "next_experiments"),
            *_extended(study, results, found),
        ),
    )


def _extended(study: Study, results: Results, found: Diagnosis) -> list[Part]:
    """Say how the study with the named effects is run."""
    if not found.extended_study:
        return []
    path = results.diagnosis(found.extended_study).as_posix()
    return [
        Part(
            "The study with the effects",
            text=f"{path} is this study with the effects that were found, at their fitted "
            "strengths. It is a study like any other:",
            command=f"snakemake --cores 2 --configfile {path}",
        )
    ]


def draw_all(results: Results, study: Study, processes: int = 1) -> list[str]:
    """Write ``diagnosis/<name>.svg`` and ``.png`` of all figures there are; return their names.

    Some processes share the figures, which do not depend on how many.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    figures = figures_of(study, diagnosis.read(study, results))
    names = list(figures)
    parallel_map(
        lambda i: draw_figure(figures[names[i]], names[i], study, results, FOLDER),
        len(names),
        processes,
    )
    for path in results.diagnosis("").iterdir():
        if path.suffix in (".svg", ".png") and path.stem not in figures:  # of an earlier diagnosis
            path.unlink()
    return names


def figures_of(study: Study, found: Diagnosis) -> dict[str, Figure]:
    """Return the figures that a diagnosis has: the curves of each quantity, and all others."""
    others = {name: figure for name, figure in FIGURES.items() if figure.applies(found)}
    return {**curve_figures(study, found), **others}


def make_diagnosis_tables(study: Study, results: Results) -> dict[str, pd.DataFrame]:
    """Write the tables of the diagnosis to ``diagnosis/tables``; return them, none without rows."""
    folder = results.diagnosis("tables")
    frames = diagnosis_tables(study, results)
    for name, table in TABLES.items():
        if name in frames:
            write_table(folder, name, table, frames[name], study)
        else:  # of an earlier diagnosis
            for kind in ("csv", "md"):
                (folder / f"{name}.{kind}").unlink(missing_ok=True)
    return frames


def diagnosis_tables(study: Study, results: Results) -> dict[str, pd.DataFrame]:
    """Return the tables of the diagnosis that have rows."""
    frames = {name: table.make(study, results) for name, table in TABLES.items()}
    return {name: frame for name, frame in frames.items() if len(frame)}
