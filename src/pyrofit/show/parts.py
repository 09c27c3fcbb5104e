"""Parts of a page: sections of text, tables and figures."""

import base64
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.show.names import titled
from pyrofit.show.style import MM, TWO_COLUMNS
from pyrofit.show.table import Table, readable
from pyrofit.show.text import number, numeric, plain_rows


@dataclass(frozen=True)
class Question:
    """A question of the summary, empty for none, with its answers; perhaps the table follows."""

    heading: str
    said: tuple[str, ...]
    table: bool = False


@dataclass(frozen=True)
class Passage:
    """A heading with sentences, a table with one body per group, its note, a command; or some."""

    title: str
    note: str = ""
    bodies: tuple[dict[str, Any], ...] = ()
    text: str = ""
    command: str = ""


@dataclass(frozen=True)
class Picture:
    """A figure of the page, with its verdict where it has one."""

    name: str
    title: str
    caption: str
    source: str
    share: float
    verdict: str = ""


@dataclass(frozen=True)
class Section:
    """A section: heading, subject, remarks, tables and figures; one on methods is folded."""

    anchor: str
    heading: str
    text: str
    parts: tuple[Passage | Picture, ...] = field(default=())
    said: tuple[str, ...] = ()
    folded: bool = False


def study_to_run(what: str, with_what: str, path: Path) -> Passage:
    """Return a part that says how a study with additions is run.

    Parameters
    ----------
    what, with_what
        What was added, for the title, and in the sentence.
    path
        The file of the study.
    """
    return Passage(
        f"The study with the {what}",
        text=f"{path.as_posix()} is this study with the {with_what}. It is a study like any other:",
        command=f"snakemake --cores 2 --configfile {path.as_posix()}",
    )


def table_part(study: Study, table: Table, frame: pd.DataFrame, text: str = "") -> Passage:
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
    return Passage(titled(study, table.title, table.paper), table.note, tuple(bodies), text)


def picture(path: Path, name: str, title: str, caption: str, verdict: str = "") -> Picture:
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
    return Picture(name, title, caption, source, round(min(share, 1.0), 3), verdict)
