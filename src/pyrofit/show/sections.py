"""All tables and figures of a study, in the sections of the report.

A file in the folder of a subject that defines ``TABLE`` or ``FIGURE`` is made by the workflow and
stands in the report. Nothing else needs to know it.
"""

from pyrofit.config import Study
from pyrofit.errors import StudyError, suggest
from pyrofit.results.files import Results
from pyrofit.show.answer import ANSWER
from pyrofit.show.costs import COSTS
from pyrofit.show.figure import Figure, draw_figure
from pyrofit.show.fit import FIT
from pyrofit.show.identification import IDENTIFICATION
from pyrofit.show.isoconversional import ISOCONVERSIONAL
from pyrofit.show.kinetics import KINETICS
from pyrofit.show.optimisers import OPTIMISERS
from pyrofit.show.section import Section
from pyrofit.show.table import Table, write_table
from pyrofit.show.truth import TRUTH
from pyrofit.show.validation import VALIDATION

SECTIONS: tuple[Section, ...] = (
    ISOCONVERSIONAL,
    KINETICS,
    VALIDATION,
    IDENTIFICATION,
    TRUTH,
    FIT,
    OPTIMISERS,
    COSTS,
)
"""The sections of the report, in its order."""
SUBJECTS: dict[str, Section] = {part.anchor: part for part in (ANSWER, *SECTIONS)}
TABLES: dict[str, Table] = {
    name: table for part in SUBJECTS.values() for name, table in part.tables.items()
}
FIGURES: dict[str, Figure] = {
    name: figure for part in SUBJECTS.values() for name, figure in part.figures.items()
}


def make_subject(subject: str, study: Study, results: Results) -> None:
    """Write all tables and figures of a subject that the study has.

    Raises
    ------
    StudyError
        There is no such subject.
    """
    if subject not in SUBJECTS:
        raise StudyError(f"unknown subject '{subject}'. {suggest(subject, SUBJECTS)}")
    part = SUBJECTS[subject]
    for name in part.tables_of(study):
        make_table(name, study, results)
    for name in part.figures_of(study):
        make_figure(name, study, results)


def make_named(name: str, study: Study, results: Results) -> None:
    """Write the table or figure of a name.

    Raises
    ------
    StudyError
        There is none of this name, or the study does not have it.
    """
    if name not in TABLES and name not in FIGURES:
        known = [*TABLES, *FIGURES]
        raise StudyError(f"unknown table or figure '{name}'. {suggest(name, known)}")
    for made, make in ((TABLES, make_table), (FIGURES, make_figure)):
        if name in made:
            make(name, study, results)


def make_table(name: str, study: Study, results: Results) -> None:
    """Write one table to ``tables/<name>.csv`` and ``.md``.

    Raises
    ------
    StudyError
        The study does not have it.
    """
    table = TABLES[name]
    if not table.applies(study):
        raise StudyError(f"study '{study.name}' has no {name}: it lacks the contents of the table")
    frame = table.make(study, results)
    write_table(results.root / "tables", name, table, frame, study)


def make_figure(name: str, study: Study, results: Results) -> None:
    """Write one figure to ``figures/<name>.svg`` and ``.png``.

    Raises
    ------
    StudyError
        The study does not have it.
    """
    figure = FIGURES[name]
    if not figure.applies(study):
        raise StudyError(f"study '{study.name}' has no {name}: it lacks the contents of the figure")
    draw_figure(figure, name, study, results)
