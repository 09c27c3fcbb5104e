"""What stands in a report: sections of text, tables and figures."""

import base64
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.figures import FIGURES
from pyrofit.figures.style import MM, TWO_COLUMNS
from pyrofit.files import Results
from pyrofit.report import comparison, determined, truth
from pyrofit.tables import TABLES, readable
from pyrofit.tables.table import Table
from pyrofit.tables.text import number, numeric, plain_rows


@dataclass(frozen=True)
class Part:
    """A heading with sentences, a table with one body per group, its note, a command; or some."""

    title: str
    note: str = ""
    bodies: tuple[dict[str, Any], ...] = ()
    text: str = ""
    command: str = ""


@dataclass(frozen=True)
class Picture:
    """A figure of the page."""

    name: str
    title: str
    caption: str
    source: str
    share: float


@dataclass(frozen=True)
class Section:
    """A section: heading, sentences, tables and figures in the order they are read."""

    anchor: str
    heading: str
    text: str
    parts: tuple[Part | Picture, ...] = field(default=())


_SECTIONS = (
    (
        "kinetics",
        "Kinetics",
        "Reaction rates from thermogravimetric analysis.",
        ("table3", "fig2", "kinetics_all_rates"),
    ),
    (
        "fit",
        "Inverse modelling",
        "Parameters from gasification, once per repetition and cost function, by SCE-UA; least "
        "squares from random starts on the same costs as a check.",
        ("table4", "fig3", "fig5", "costs", "fig1", "table6", "table5"),
    ),
    (
        "truth",
        "Truth and estimate",
        "The data are computed from known parameter values.",
        ("truth",),
    ),
    (
        "identification",
        "What the data determine",
        "Optimum and curvature of the likelihood, from the noise of the signals.",
        ("determined", "profiles", "sensitivities", "correlation", "noise", "distances"),
    ),
    (
        "validation",
        "Validation",
        "The best sets, simulated at experiments and signals they were not fitted to.",
        ("fig4", "residuals", "back_temperature", "optimisers", "validation", "good_sets", "bands"),
    ),
    (
        "comparison",
        "Optimisers and cost functions compared",
        "All sets of all optimisers, under all cost functions and on one metric.",
        ("every_cost", "cost_tests", "spread", "correlation_of_sets"),
    ),
)


def tables_of(study: Study, results: Results) -> dict[str, pd.DataFrame]:
    """Return all tables that the study has, by name."""
    return {
        name: table.make(study, results) for name, table in TABLES.items() if table.applies(study)
    }


def sections(study: Study, results: Results, tables: dict[str, pd.DataFrame]) -> list[Section]:
    """Return the sections that have something to show."""
    found = []
    for anchor, heading, text, names in _SECTIONS:
        parts: list[Part | Picture] = []
        for name in names:
            if name in tables:
                parts.append(table_part(TABLES[name], tables[name]))
            elif name in FIGURES and FIGURES[name].applies(study):
                path = results.root / "figures" / f"{name}.svg"
                parts.append(picture(path, name, FIGURES[name].title, FIGURES[name].caption))
        if anchor == "truth" and parts:
            text = " ".join([text, *truth.sentences(tables["truth"])])
        if anchor == "comparison":
            text = " ".join([text, *comparison.sentences(study, results, tables)])
        if anchor == "identification":
            text = " ".join([text, *determined.sentences(tables)])
        if parts:
            found.append(Section(anchor, heading, text, tuple(parts)))
    return found


def table_part(table: Table, frame: pd.DataFrame, text: str = "") -> Part:
    """Return a table as a part of a page, with sentences before it."""
    bodies = tuple(
        {
            "heading": heading,
            "columns": [(column, numeric(part[column])) for column in part.columns],
            "rows": [[number(cell) for cell in row] for row in plain_rows(part)],
        }
        for heading, part in readable(table, frame)
    )
    return Part(table.title, table.note, bodies, text)


def picture(path: Path, name: str, title: str, caption: str) -> Picture:
    """Embed a drawn figure; as an image, its identifiers cannot clash with those of others.

    Raises
    ------
    DataError
        It has not been drawn.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror}); draw it first") from None
    source = "data:image/svg+xml;base64," + base64.b64encode(content).decode()
    width = re.search(rb'<svg[^>]* width="([\d.]+)pt"', content)
    share = float(width[1]) / (TWO_COLUMNS * MM * 72.0) if width else 1.0
    return Picture(name, title, caption, source, round(min(share, 1.0), 3))
