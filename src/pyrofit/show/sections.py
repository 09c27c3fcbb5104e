"""All tables and figures of a study, in the subjects of its report.

A file in the folder of a subject that defines ``TABLE`` or ``FIGURE`` is made by the workflow and
stands in the report. Nothing else needs to know it.
"""

from pyrofit.config import Study
from pyrofit.discovery import rooms
from pyrofit.errors import StudyError, suggest
from pyrofit.results.files import Results
from pyrofit.show import subjects
from pyrofit.show.figure import Figure
from pyrofit.show.page import Page
from pyrofit.show.table import Table

_PAGES: dict[str, Page] = rooms(subjects.__name__, subjects.__path__, "PAGE")
SUBJECTS = dict(sorted(_PAGES.items(), key=lambda item: item[1].place))
"""The subjects of the report, in its order."""
TABLES: dict[str, Table] = {
    name: table for page in SUBJECTS.values() for name, table in page.tables.items()
}
FIGURES: dict[str, Figure] = {
    name: figure for page in SUBJECTS.values() for name, figure in page.figures.items()
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
    SUBJECTS[subject].write(study, results)


def make_named(name: str, study: Study, results: Results) -> None:
    """Write the table or figure of a name.

    Raises
    ------
    StudyError
        There is none of this name, or the study does not have it.
    """
    known = [*TABLES, *FIGURES]
    if name not in known:
        raise StudyError(f"unknown table or figure '{name}'. {suggest(name, known)}")
    for page in SUBJECTS.values():
        if name in page.tables:
            page.write_table(name, study, results)
        if name in page.figures:
            page.draw(name, study, results)
