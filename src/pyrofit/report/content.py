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
from pyrofit.figures.robustness import CAPTION, TITLE
from pyrofit.figures.style import MM, TWO_COLUMNS
from pyrofit.report import comparison, determined, remarks, truth
from pyrofit.results.files import Results, read_csv
from pyrofit.tables import TABLES, readable
from pyrofit.tables.describe import titled
from pyrofit.tables.robustness import ROBUSTNESS
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
    """A section: heading, what it is about, remarks, tables and figures as they are read."""

    anchor: str
    heading: str
    text: str
    parts: tuple[Part | Picture, ...] = field(default=())
    said: tuple[str, ...] = ()


_SECTIONS = (
    (
        "kinetics",
        "Kinetics",
        "Reaction rates from thermogravimetric analysis.",
        ("fig2", "table3", "kinetics_all_rates"),
    ),
    (
        "fit",
        "Fit",
        "Inverse modelling: parameters from gasification, once per repetition and cost function, "
        "by SCE-UA.",
        ("fig3", "table4", "table6"),
    ),
    (
        "identification",
        "What the data determine",
        "Optimum and curvature of the likelihood, from the noise of the signals.",
        (
            "determined",
            "known_values",
            "profiles",
            "sensitivities",
            "correlation",
            "noise",
            "distances",
        ),
    ),
    (
        "truth",
        "Truth and estimate",
        "The data are computed from known parameter values.",
        ("truth",),
    ),
    (
        "validation",
        "Validation",
        "The best sets, simulated at experiments and signals they were not fitted to.",
        ("fig4", "residuals", "back_temperature", "validation", "good_sets", "bands"),
    ),
    (
        "optimisation",
        "Optimisers",
        "SCE-UA, and from random starts on the same costs least squares and CMA-ES.",
        ("costs", "fig5", "optimisers"),
    ),
    (
        "costs",
        "Cost functions",
        "All sets of all optimisers, under all cost functions and on one metric.",
        ("fig1", "table5", "every_cost", "cost_tests", "spread", "correlation_of_sets"),
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
                parts.append(table_part(study, TABLES[name], tables[name]))
            elif name in FIGURES and FIGURES[name].applies(study):
                figure, path = FIGURES[name], results.root / "figures" / f"{name}.svg"
                title = titled(study, figure.title, figure.paper)
                parts.append(picture(path, name, title, figure.caption))
        if not parts:
            continue
        said = _said(anchor, study, results, tables)
        # Robustness is a step of its own, which a study may go without.
        if anchor == "costs" and results.robustness("table.csv").is_file():
            parts += _robustness(study, results)
        found.append(Section(anchor, heading, text, tuple(parts), tuple(said)))
    return found


def _said(
    anchor: str, study: Study, results: Results, tables: dict[str, pd.DataFrame]
) -> list[str]:
    """Return the remarks of a section."""
    match anchor:
        case "kinetics":
            return remarks.kinetics(study, tables)
        case "fit":
            return remarks.fit(study, tables)
        case "identification":
            return determined.sentences(tables)
        case "truth":
            return truth.sentences(tables["truth"])
        case "validation":
            return [*remarks.validation(study, tables), comparison.good_sets(tables)]
        case "optimisation":
            return comparison.optimisers(study, results, tables)
        case _:
            return comparison.costs(tables)


def _robustness(study: Study, results: Results) -> list[Part | Picture]:
    """Return table and figure of the twins, with their sentences."""
    frame = read_csv(results.robustness("table.csv"))
    text = " ".join(comparison.robustness(study, results))
    return [
        table_part(study, ROBUSTNESS, frame, text),
        picture(results.robustness("robustness.svg"), "robustness", TITLE, CAPTION),
    ]


def table_part(study: Study, table: Table, frame: pd.DataFrame, text: str = "") -> Part:
    """Return a table as a part of a page, with sentences before it.

    Bodies and rows that belong to one cost function say so under ``cost`` and ``costs``.
    """
    named = {table.headings.get(name, name) for name in ("cost_function", "fitted_with")}
    bodies = []
    for heading, part in readable(table, frame):
        cost = next((column for column in part.columns if column in named), None)
        bodies.append(
            {
                "heading": heading,
                "cost": heading if table.group_by == "cost_function" else "",
                "columns": [(column, numeric(part[column])) for column in part.columns],
                "rows": [[number(cell) for cell in row] for row in plain_rows(part)],
                "costs": [""] * len(part) if cost is None else part[cost].astype(str).tolist(),
            }
        )
    return Part(titled(study, table.title, table.paper), table.note, tuple(bodies), text)


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
