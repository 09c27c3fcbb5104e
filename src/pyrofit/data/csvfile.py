"""Read a table of numbers with a header, in any of the shapes in which laboratories write one."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from pyrofit.data.blocks import Block, blocks_below
from pyrofit.data.bulk import bulk_values
from pyrofit.data.cone_exports import is_export, unfolded
from pyrofit.data.csvheading import Heading, named_columns
from pyrofit.data.layout import cells_of, layout_of, usual_delimiter
from pyrofit.data.line import FileLine
from pyrofit.data.numerals import (
    Numerals,
    fault_of,
    is_numeral,
    numerals_of,
    of_parts,
    seconds_of_text,
)
from pyrofit.data.rows import parsed, rows_of, whole_rows, without_footer
from pyrofit.data.sections import first_table
from pyrofit.data.stated import Stated, exothermic_up, stated_in
from pyrofit.data.text_file import read_text
from pyrofit.errors import DataError
from pyrofit.quantities.units import SCALES, unit_key

FloatArray = npt.NDArray[np.float64]
MANY_ROWS = 20_000
"""Files with more lines are read in one piece where that is possible."""
_LOOKED_AT = 2000
_CLOCKS = ("hh:mm:ss", "h:mm:ss", "h:min:s", "hms")
_WITH_TENTHS = re.compile(r"\d+:\d\d[.,]\d+")
_PARTS_OF_TIME = ("mm:ss", "min:s", "hh:mm")


@dataclass(frozen=True, eq=False)
class FileTable:
    """Columns of numbers, in the file's own units.

    Parameters
    ----------
    path : Path
        The file that was read.
    columns : dict of str to array, shape (n_rows,)
        The numbers by column name, in the order of the file; NaN where a cell holds none.
    units : dict of str to str or None
        The unit by column name as the file writes it, without brackets; None where there is none.
    first_row : int
        Line number, from 1, of the first row of numbers in the file.
    left_out : tuple of int
        Rows of the file, from 0, that the columns do not have any more.
    mended : tuple of str
        Notes on all that is no table in UTF-8 with decimal points.
    texts : dict of str to dict of str to int
        Texts of the cells that hold no number, each with its first line, by column that has some.
    area_m2 : float, optional
        Exposed area of the sample [m2], where the file tells it.
    stated : Stated
        Facts that the file states above its table.
    blocks : tuple of Block
        Tests side by side, where a row above the names labels them.
    """

    path: Path
    columns: dict[str, FloatArray]
    units: dict[str, str | None]
    first_row: int
    left_out: tuple[int, ...] = ()
    mended: tuple[str, ...] = ()
    texts: dict[str, dict[str, int]] = field(default_factory=dict)
    area_m2: float | None = None
    stated: Stated = field(default_factory=Stated)
    blocks: tuple[Block, ...] = ()

    @property
    def faults(self) -> dict[str, tuple[int, str]]:
        """Line number and text of the first cell that holds no number, by column that has one."""
        firsts = {name: next(iter(texts.items())) for name, texts in self.texts.items()}
        return {name: (line, text) for name, (text, line) in firsts.items()}

    def line(self, row: int) -> int:
        """Return the line number, from 1, of a row of the columns."""
        rows = len(next(iter(self.columns.values()))) + len(self.left_out)
        return self.first_row + int(np.delete(np.arange(rows), self.left_out)[row])

    def require(self, names: Sequence[str]) -> None:
        """Refuse columns that are to be used and hold a cell that is no number.

        Raises
        ------
        DataError
            With file, line, column and text.
        """
        for name in names:
            if name in self.faults:
                line, cell = self.faults[name]
                raise DataError(
                    f"{self.path}, line {line}, column '{name}': given '{cell}'; {fault_of(cell)}"
                )


def read_table(path: Path) -> FileTable:
    r"""Read a delimited text file: header, units row or units in the header, and numbers.

    The encoding is UTF-8, UTF-16 or Windows-1252. Comma, semicolon, tab, bar or blanks separate
    cells. Decimal points and commas are read, and separators of thousands where the file tells them
    apart. A preamble above the header, times as hh:mm:ss and a few lines of text at the end are
    read as well. Any deviation from UTF-8, decimal points and a header in the first row is noted.
    Units stand in a row below or above the names (`[s],[K]`), or in the names (`Time (s)`,
    `Mass [mg]`, `Mass/%`), or nowhere. A cell that is no number does not matter in a column that
    nobody uses.

    Parameters
    ----------
    path : Path
        A text file on a disk.

    Returns
    -------
    Table
        The columns, unconverted.

    Raises
    ------
    DataError
        The file cannot be read, or has no header or no numbers. A row is longer or shorter than the
        header. The numbers can be read in two ways.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "tga.csv"
    ...     _ = path.write_text("Time,Mass\n[s],[mg]\n0,5.0\n10,4.5\n")
    ...     table = read_table(path)
    >>> table.columns["Mass"].tolist(), table.units["Mass"], table.line(0)
    ([5.0, 4.5], 'mg', 3)
    """
    notes: list[str] = []
    table, above = _read(path, notes)
    cells = [re.split(r"[\t;|]|,(?!\d)|(?<!\d),", text) for text in above]
    stated = stated_in(cells)
    if stated.exothermic_up is None:
        stated = replace(stated, exothermic_up=exothermic_up(table.columns))
    area = stated.area_m2 if table.area_m2 is None else table.area_m2
    return replace(table, stated=stated, area_m2=area)


def _read(path: Path, notes: list[str]) -> tuple[FileTable, list[str]]:
    """Return the table of a file, and the lines above it."""
    raw = re.split(r"\r\n|\n|\r", read_text(path, notes))
    while raw and not raw[-1].strip(' \t;,|"'):
        raw.pop()
    delimiter = usual_delimiter(path, raw)
    if is_export([cells_of(path, text, delimiter) for text in raw[:_LOOKED_AT]]):
        lines = [
            FileLine(i, cells_of(path, text, delimiter)) for i, text in enumerate(raw, start=1)
        ]
        (first, *rows), area = unfolded(path, [line for line in lines if any(line.cells)], notes)
        table = _table(path, named_columns(path, [first], notes), rows, notes)
        return replace(table, area_m2=area), raw[: first.number]
    layout = layout_of(path, raw, notes)
    above = raw[: max(layout.heading[0].number - 1, 0)] if layout.heading else []
    heading = named_columns(path, layout.heading, notes)
    labels = next((text for text in reversed(above) if text.strip()), "")
    blocks = blocks_below(cells_of(path, labels, layout.delimiter), heading.given, heading.names)
    raw = without_footer(path, raw, layout, notes)
    if len(raw) > MANY_ROWS and not layout.marks:
        numerals = numerals_of(rows_of(path, raw[: layout.start + _LOOKED_AT], layout))
        width = len(heading.names)
        values = bulk_values(raw[layout.start :], layout.delimiter, numerals, width)
        if values is not None:
            notes += _notes_on(numerals)
            table = _as_table(path, heading, values, {}, layout.start + 1, (), notes)
            return replace(table, blocks=blocks), above
    lines = rows_of(path, raw, layout)
    whole = first_table(lines, heading, notes) if layout.export else lines
    table = _table(path, heading, whole, notes, layout.marks)
    return replace(table, blocks=blocks), above


def holds_unclear_numbers(table: FileTable, name: str) -> bool:
    """Tell whether the first cell of a column that is no number looks like one, such as 4,999."""
    return name in table.faults and is_numeral(table.faults[name][1])


def _table(
    path: Path, heading: Heading, lines: list[FileLine], notes: list[str], marks: bool = False
) -> FileTable:
    """Return the table of lines of cells."""
    rows = _whole_times(whole_rows(path, lines, heading, marks, notes), heading)
    numerals = numerals_of(rows)
    notes += _notes_on(numerals)
    values, texts = parsed(rows, len(heading.names), numerals, notes)
    clocks = [seconds_of_text(cell) is not None for cell in rows[0].cells]
    units = [
        _of_clock(unit) if clock else unit
        for unit, clock in zip(heading.units, clocks, strict=False)
    ]
    heading = replace(heading, units=units)
    first, kept = lines[0].number, {row.number for row in rows}
    between = range(first, rows[-1].number)
    left_out = tuple(number - first for number in between if number not in kept)
    return _as_table(path, heading, values, texts, first, left_out, notes)


def _whole_times(rows: list[FileLine], heading: Heading) -> list[FileLine]:
    """Return rows whose times mm:ss and hh:mm, as heading or fractions tell them, are hh:mm:ss."""
    of = {i: (u or "").casefold() for i, u in enumerate(heading.units)}
    of = {i: unit for i, unit in of.items() if unit in _PARTS_OF_TIME}
    of |= {i: "mm:ss" for i, cell in enumerate(rows[0].cells) if _WITH_TENTHS.fullmatch(cell)}
    if not of:
        return rows
    return [
        FileLine(
            row.number, [of_parts(c, of[i]) if i in of else c for i, c in enumerate(row.cells)]
        )
        for row in rows
    ]


def _notes_on(numerals: Numerals) -> list[str]:
    """Note another form of the numbers than decimal points."""
    notes = ["read with decimal commas"] if numerals.decimal == "," else []
    if numerals.thousands:
        notes.append(f"read with '{numerals.thousands}' between thousands")
    return notes


def _as_table(
    path: Path,
    heading: Heading,
    values: FloatArray,
    texts: Mapping[int, dict[str, int]],
    first_row: int,
    left_out: tuple[int, ...],
    notes: Sequence[str],
) -> FileTable:
    """Return the table of an array, without columns that have neither name nor numbers."""
    used = [
        i
        for i in range(len(heading.names))
        if heading.given[i] or i in texts or not np.isnan(values[:, i]).all()
    ]
    names = {i: heading.names[i] for i in used}
    return FileTable(
        path,
        {name: values[:, i].copy() for i, name in names.items()},
        {name: _unit(heading.units[i]) for i, name in names.items()},
        first_row,
        left_out,
        tuple(notes),
        {names[i]: of_column for i, of_column in texts.items()},
    )


def _of_clock(unit: str | None) -> str | None:
    """Return s as the unit of a column of times hh:mm:ss, unless that of its name is no time."""
    times = {unit_key(word) for word in (*SCALES["time"], *_CLOCKS, *_PARTS_OF_TIME)}
    return "s" if unit is None or unit_key(unit) in times else unit


def _unit(unit: str | None) -> str | None:
    """Return the unit of a column; times of a clock are read as seconds."""
    return "s" if unit is not None and unit.casefold() in _CLOCKS else unit
