"""The choice of a reaction scheme: tables and figure, and a section of the report."""

from pyrofit.config import Study
from pyrofit.results import scheme
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.parts import Part, Shown, picture, table_part
from pyrofit.show.scheme.figure import CAPTION, TITLE, figure
from pyrofit.show.scheme.table import PARAMETERS, SCHEMES
from pyrofit.show.table import read_table, write_table

FOLDER = "scheme"
_TABLES = {"schemes": SCHEMES, "parameters": PARAMETERS}


def draw_and_write(study: Study, results: Results) -> None:
    """Write the tables, then the figure, to ``scheme``.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    for name, table in _TABLES.items():
        write_table(results.scheme(""), name, table, table.make(study, results), study)
    with style.style():
        style.save(figure(study, results), results, FOLDER, FOLDER)


def section(study: Study, results: Results) -> Shown:
    """Return the chosen scheme as a section of the report.

    Raises
    ------
    DataError
        A result or the figure is missing.
    """
    found = scheme.read(study, results)
    made = [
        table_part(study, table, read_table(results, name, FOLDER))
        for name, table in _TABLES.items()
    ]
    path = results.scheme(found.extended_study).as_posix()
    return Shown(
        "scheme",
        "Reaction scheme",
        "The scheme that predicts heating rates left out of its fit.",
        (
            Part("Chosen scheme", note=found.rule, text=found.words),
            *made,
            picture(results.scheme(f"{FOLDER}.svg"), FOLDER, TITLE, CAPTION),
            Part(
                "The study with the chosen scheme",
                text=f"{path} is this study with the chosen scheme at its fitted values. It is a "
                "study like any other:",
                command=f"snakemake --cores 2 --configfile {path}",
            ),
        ),
    )
