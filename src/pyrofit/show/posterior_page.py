"""Draws from the posterior: tables and figures, and a section of the report."""

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.figure import draw_figure
from pyrofit.show.parts import Shown, picture, table_part
from pyrofit.show.posterior.figures import FIGURES
from pyrofit.show.posterior.sentences import sentences
from pyrofit.show.posterior.tables import TABLES
from pyrofit.show.table import read_table, write_table

FOLDER = "posterior"
ON_PAGE = ("parameters", "lacking", "bands")
"""The tables of the report; all are in the folder."""


def draw_and_write(study: Study, results: Results) -> None:
    """Write the tables, then the figures, to ``posterior``.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    for name, table in TABLES.items():
        frame = table.make(study, results)
        write_table(results.posterior(""), f"table_{name}", table, frame, study)
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
        picture(results.posterior(f"{name}.svg"), f"posterior_{name}", of.title, of.caption)
        for name, of in FIGURES.items()
    ]
    tables = [
        table_part(study, TABLES[name], read_table(results, f"table_{name}", FOLDER))
        for name in ON_PAGE
    ]
    return Shown(
        "posterior",
        "Predictions with bands",
        "Parameters are drawn from their posterior distribution; every experiment is predicted "
        "with the draws.",
        (*drawn, *tables),
        tuple(sentences(study, results)),
    )
