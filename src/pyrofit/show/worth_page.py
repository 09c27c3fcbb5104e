"""Data worth: table and figure, and a section of the report."""

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.figure import draw_figure
from pyrofit.show.parts import Shown, picture, table_part
from pyrofit.show.table import read_table, write_table
from pyrofit.show.worth.figures import FIGURES
from pyrofit.show.worth.sentences import sentences
from pyrofit.show.worth.tables import TABLES

FOLDER = "worth"


def draw_and_write(study: Study, results: Results) -> None:
    """Write the table, then the figure, to ``worth``.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    for name, table in TABLES.items():
        write_table(results.worth(""), f"table_{name}", table, table.make(study, results), study)
    for name, figure in FIGURES.items():
        draw_figure(figure, name, study, results, FOLDER)


def section(study: Study, results: Results) -> Shown:
    """Return what was found as a section of the report.

    Raises
    ------
    DataError
        A result or a figure is missing.
    """
    drawn = [
        picture(results.worth(f"{name}.svg"), f"worth_{name}", figure.title, figure.caption)
        for name, figure in FIGURES.items()
    ]
    tables = [
        table_part(study, table, read_table(results, f"table_{name}", FOLDER))
        for name, table in TABLES.items()
    ]
    return Shown(
        "worth",
        "What to measure next",
        "By how much each planned test would narrow parameters and predictions.",
        (*drawn, *tables),
        tuple(sentences(study, results)),
    )
