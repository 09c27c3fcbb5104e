"""Stored sets under all costs: tables and figures, and a section of the report."""

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.figure import draw_figure
from pyrofit.show.parts import Shown, picture, table_part
from pyrofit.show.rescore.figures import FIGURES
from pyrofit.show.rescore.sentences import sentences
from pyrofit.show.rescore.tables import TABLES
from pyrofit.show.table import read_table, write_table

FOLDER = "rescore"
ON_PAGE = ("agreement", "agreement_best", "valleys")
"""The figures of the report; all are in the folder."""


def draw_and_write(study: Study, results: Results) -> None:
    """Write the tables, then the figures, to ``rescore``.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    for name, table in TABLES.items():
        write_table(results.rescored(""), f"table_{name}", table, table.make(study, results), study)
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
        picture(
            results.rescored(f"{name}.svg"),
            f"rescore_{name}",
            FIGURES[name].title,
            FIGURES[name].caption,
        )
        for name in ON_PAGE
    ]
    best = table_part(study, TABLES["best"], read_table(results, "table_best", FOLDER))
    return Shown(
        "rescore",
        "Stored sets under other costs",
        "All searches store every model call. A sample of these sets is scored again under other "
        "costs.",
        (*drawn, best),
        tuple(sentences(study, results)),
    )
