"""The diagnosis as a section of a report and as a page of its own."""

from collections.abc import Sequence
from dataclasses import replace

from pyrofit.config import Study
from pyrofit.parallel import parallel_map
from pyrofit.results import diagnosis, recorded
from pyrofit.results.diagnosis_schema import Diagnosis
from pyrofit.results.files import Results, write_text
from pyrofit.show.diagnosis import FIGURES, TABLES
from pyrofit.show.diagnosis.curves import curve_figures
from pyrofit.show.diagnosis.sentences import (
    certainty,
    gap_closed,
    missing_sentences,
    next_measured,
    summary_sentences,
    where_off,
)
from pyrofit.show.html import page_of
from pyrofit.show.measured import use_in_diagnosis
from pyrofit.show.page import Page, pages_of_steps
from pyrofit.show.parts import Passage, Question, study_to_run
from pyrofit.show.table import Frames, always, write_table


def is_drawn(study: Study, results: Results) -> bool:
    """Tell whether a study has been diagnosed and that is drawn: its page is written last."""
    return results.diagnosis("report.html").is_file()


def _extended(study: Study, results: Results) -> Sequence[Passage]:
    """Say how the study with the named effects is run."""
    found = diagnosis.read(study, results)
    if not found.extended_study:
        return ()
    path = results.diagnosis(found.extended_study)
    words = "effects that were found, at their fitted strengths"
    return (study_to_run("effects", words, path),)


PAGE = Page(
    "diagnosis",
    heading="Missing effects",
    text="The misfit of the model, the effects that explain it, and the confidence in them.",
    tables=TABLES,
    figures={},
    folders=("diagnosis/tables", "diagnosis"),
    written=False,
    about={
        100: lambda study, found: where_off(found),
        200: lambda study, found: missing_sentences(found),
        500: lambda study, found: gap_closed(found),
        600: certainty,
        800: lambda study, found: next_measured(found),
    },
    exists=is_drawn,
    more=_extended,
)
"""The page without its figures: `page_of_diagnosis` adds those that a diagnosis has."""


def page_of_diagnosis(study: Study, found: Diagnosis) -> Page:
    """Return the page with the figures that a diagnosis has, curves of each quantity first."""
    others = {n: replace(f, applies=always) for n, f in FIGURES.items() if f.applies(found)}
    return replace(PAGE, figures={**curve_figures(study, found), **others})


def write_page(study: Study, results: Results) -> None:
    """Write ``diagnosis/report.html`` and the tables, from the results and the drawn figures.

    Raises
    ------
    DataError
        A result or a figure is missing.
    """
    frames = write_diagnosis_tables(study, results)
    found = diagnosis.read(study, results)
    shown = [page_of_diagnosis(study, found).section(study, results, found, frames)]
    shown += [page.section(study, results) for page in pages_of_steps("diagnosis", study, results)]
    title = f"{study.title or study.name}: diagnosis"
    measured = recorded.measured(study, results)
    said = [Question("", tuple(summary_sentences(found)))]
    text = page_of(study, measured, title, said, shown, use=use_in_diagnosis)
    write_text(results.diagnosis("report.html"), text)


def draw_all(results: Results, study: Study, processes: int = 1) -> list[str]:
    """Write ``diagnosis/<name>.svg`` and ``.png`` of all figures there are; return their names.

    Some processes share the figures, which do not depend on how many.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    page = page_of_diagnosis(study, diagnosis.read(study, results))
    names = list(page.figures)
    parallel_map(lambda i: page.draw(names[i], study, results), len(names), processes)
    for path in results.diagnosis("").iterdir():
        if path.suffix in (".svg", ".png") and path.stem not in names:  # of an earlier diagnosis
            path.unlink()
    return names


def write_diagnosis_tables(study: Study, results: Results) -> Frames:
    """Write the tables of the diagnosis to ``diagnosis/tables``; return them, none without rows."""
    folder = results.diagnosis("tables")
    frames = PAGE.frames(study, results)
    for name, table in TABLES.items():
        if name in frames:
            write_table(folder, name, table, frames[name], study)
        else:  # of an earlier diagnosis
            for kind in ("csv", "md"):
                (folder / f"{name}.{kind}").unlink(missing_ok=True)
    return frames
