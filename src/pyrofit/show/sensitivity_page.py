"""Sensitivity over time: tables and figures, and a section of the report."""

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.figure import draw_figure
from pyrofit.show.parts import Shown, picture, table_part
from pyrofit.show.sensitivity.figures import FIGURES
from pyrofit.show.sensitivity.sentences import sentences
from pyrofit.show.sensitivity.tables import TABLES
from pyrofit.show.table import read_table, write_table

FOLDER = "sensitivity"
ON_PAGE = ("total", "apparatus", "costs")
"""The figures of the report; all are in the folder."""


def draw_and_write(study: Study, results: Results) -> None:
    """Write the tables, then the figures, to ``sensitivity``.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    for name, table in TABLES.items():
        frame = table.make(study, results)
        write_table(results.sensitivity(""), f"table_{name}", table, frame, study)
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
            results.sensitivity(f"{name}.svg"),
            f"sensitivity_{name}",
            FIGURES[name].title,
            FIGURES[name].caption,
        )
        for name in ON_PAGE
    ]
    inputs = table_part(study, TABLES["inputs"], read_table(results, "table_inputs", FOLDER))
    return Shown(
        "sensitivity",
        "Sensitivity of signals and costs",
        "Variance-based sensitivity: parameters and values of the apparatus vary together, and "
        "the variance of signals and costs is shared out between them.",
        (*drawn, inputs),
        tuple(sentences(study, results)),
    )
