"""Definition of a table, and its output."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv, write_csv, write_text
from pyrofit.show.names import titled
from pyrofit.show.text import groups, markdown, turned

Frames = dict[str, pd.DataFrame]
Row = dict[str, object]
"""A row of a table, by column."""


def always(study: Study) -> bool:
    """Tell that every study has a table or figure."""
    return True


@dataclass(frozen=True)
class Table:
    """A table: when a study has it, how it is made from results, and how it is read."""

    place: int
    """Place in its section, in ascending order."""
    make: Callable[[Study, Results], pd.DataFrame]
    title: str
    applies: Callable[[Study], bool] = always
    note: str = ""
    headings: Mapping[str, str] = field(default_factory=dict)
    group_by: str | None = None
    paper: str = ""
    """Table of the paper that it reproduces, such as 'Table 4'."""
    upright: str | None = None
    """Column whose values become the headings where the table is read: few rows, many columns."""
    shown: bool = True
    """Whether the report shows it; else it is written alone."""


def write_table(folder: Path, name: str, table: Table, frame: pd.DataFrame, study: Study) -> None:
    """Write a table to ``<folder>/<name>.csv`` and ``.md``."""
    write_csv(folder / f"{name}.csv", frame)
    write_text(folder / f"{name}.md", _page(study, table, frame))


def read_written_table(results: Results, name: str, folder: str = "tables") -> pd.DataFrame:
    """Read a table that was written.

    Raises
    ------
    DataError
        It is missing or broken.
    """
    return read_csv(results.folder(folder) / f"{name}.csv")


def readable(table: Table, frame: pd.DataFrame) -> list[tuple[str, pd.DataFrame]]:
    """Return a table as it is read: in parts with a heading each, columns named in words."""
    if table.upright is not None:
        frame = turned(frame, table.upright, table.headings)
    headings = {**table.headings, **_of_units(table, frame)}
    return [
        (heading, part.rename(columns=headings)) for heading, part in groups(frame, table.group_by)
    ]


def _of_units(table: Table, frame: pd.DataFrame) -> dict[str, str]:
    """Return the headings of columns ``measure [unit]`` whose measure has a heading."""
    found = {}
    for column in map(str, frame.columns):
        measure, bracket, unit = column.partition(" [")
        if bracket and measure in table.headings:
            found[column] = f"{table.headings[measure]} [{unit}"
    return found


def _page(study: Study, table: Table, frame: pd.DataFrame) -> str:
    synthetic = " (synthetic data)" if study.is_synthetic else ""
    parts = [f"# {titled(study, table.title, table.paper)}{synthetic}\n"]
    for heading, part in readable(table, frame):
        parts += [f"## {heading}\n"] if heading else []
        parts.append(markdown(part))
    parts += [table.note + "\n"] if table.note else []
    return "\n".join(parts)
