"""Read a table of numbers with a header, in any of the shapes in which laboratories write one."""

import csv
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

import numpy as np
import numpy.typing as npt

from pyrofit.data.cone_exports import is_ftt, unfolded
from pyrofit.data.csvheading import Line, is_number, name_columns, ragged, trim
from pyrofit.data.mend import decoded, mended_lines
from pyrofit.errors import DataError, suggest

FloatArray = npt.NDArray[np.float64]

_DELIMITERS = "\t;,"
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
_LISTED_FILES = 12


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of numbers, in the file's own units.

    Parameters
    ----------
    path : Path
        The file that was read.
    columns : dict of str to array, shape (n_rows,)
        The numbers by column name, in the order of the file; NaN where a cell is empty.
    units : dict of str to str or None
        The unit by column name as the file writes it, without brackets; None where there is none.
    first_row : int
        Line number, from 1, of the first row of numbers in the file.
    left_out : tuple of int
        Rows of the file, from 0, that the columns do not have any more.
    mended : tuple of str
        What was wrong with the text of the file and was read all the same, and the form of an
        export that was unfolded.
    """

    path: Path
    columns: dict[str, FloatArray]
    units: dict[str, str | None]
    first_row: int
    left_out: tuple[int, ...] = ()
    mended: tuple[str, ...] = ()

    def line(self, row: int) -> int:
        """Return the line number, from 1, of a row of the columns."""
        rows = len(next(iter(self.columns.values()))) + len(self.left_out)
        return self.first_row + int(np.delete(np.arange(rows), self.left_out)[row])


def read_table(path: Path, mend: bool = False) -> Table:
    r"""Read a delimited text file: header, units row or units in the header, and numbers.

    The delimiter is a comma, a semicolon or a tab, the decimal sign a point. Units stand in a row
    below or above the names (`[s],[K]`), or in the names (`Time (s)`, `Mass [mg]`), or nowhere.

    Parameters
    ----------
    path : Path
        A UTF-8 text file, with or without a byte-order mark.
    mend : bool
        Read over other encodings, a preamble, words such as `NaN` for a cell without a value, and
        rows at the end without a first cell; the table lists them. Measured series of a study are
        never mended.

    Returns
    -------
    Table
        The columns, unconverted.

    Raises
    ------
    DataError
        The file cannot be read, has no header or no numbers, a row is longer or shorter than the
        header, two columns share a name, or a cell is neither empty nor a finite number.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "tga.csv"
    ...     _ = path.write_text("Time,Mass\n[s],[mg]\n0,5.0\n10,4.5\n")
    ...     table = read_table(path)
    >>> table.columns["Mass"].tolist(), table.units["Mass"], table.first_row
    ([5.0, 4.5], 'mg', 3)
    """
    notes: list[str] = []
    lines = unfolded(path, _split(path, _read_text(path, notes, mend)), notes)
    if mend:
        lines = mended_lines(lines, notes)
    count = _count_text_lines(path, lines)
    names, units = name_columns(path, lines[:count])
    rows = _trim_rows(path, lines[count:], len(names))
    values = np.array([_parse_row(path, row, names) for row in rows], dtype=np.float64)
    columns = {name: values[:, i].copy() for i, name in enumerate(names)}
    named = dict(zip(names, units, strict=True))
    return Table(path, columns, named, rows[0].number, mended=tuple(notes))


def _read_text(path: Path, notes: list[str], mend: bool) -> str:
    try:
        data = path.read_bytes()
        return decoded(data, notes) if mend or is_ftt(data) else data.decode("utf-8-sig")
    except FileNotFoundError:
        raise DataError(f"{path}: there is no such file. {_near_files(path)}") from None
    except IsADirectoryError:
        raise DataError(f"{path}: this is a folder; give a file in it.") from None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise DataError(
            f"{path}, line {line}: byte 0x{error.object[error.start]:02x} is not UTF-8 text; "
            "save the file as CSV in UTF-8."
        ) from None
    except OSError as error:
        raise DataError(
            f"{path}: the file cannot be read ({error.strerror}); "
            "check its permissions and its disk."
        ) from None
    except ValueError:
        raise DataError(f"{str(path)!r}: this is no name of a file; correct it.") from None


def _near_files(path: Path) -> str:
    if not path.parent.is_dir():
        return f"Its folder {path.parent} does not exist either; check the path."
    names = sorted(entry.name for entry in path.parent.iterdir() if entry.is_file())
    if not names:
        return f"Its folder {path.parent} holds no files; check the path."
    if len(names) > _LISTED_FILES:
        names = get_close_matches(path.name, names, _LISTED_FILES, 0.0)
    return suggest(path.name, names)


def _split(path: Path, text: str) -> list[Line]:
    """Cut the text in lines and cells, without the blank lines around the header and at the end."""
    raw = re.split(r"\r\n|\n|\r", text)
    header = next((line for line in raw if "".join(line.split()).strip(_DELIMITERS + '"')), None)
    if header is None:
        raise DataError(f"{path}: the file is empty; a header row and rows of numbers are needed.")
    delimiter = max(_DELIMITERS, key=header.count)
    try:
        cells = [next(csv.reader([line], delimiter=delimiter), []) for line in raw]
    except csv.Error as error:
        raise DataError(f"{path}: this is not a delimited text file ({error}).") from None
    lines = [Line(i, [c.strip() for c in row]) for i, row in enumerate(cells, start=1)]
    while not any(lines[-1].cells):
        lines.pop()
    first_number = next((i for i, line in enumerate(lines) if _has_number(line)), len(lines))
    return [line for line in lines[:first_number] if any(line.cells)] + lines[first_number:]


def _has_number(line: Line) -> bool:
    return any(is_number(cell) for cell in line.cells)


def _count_text_lines(path: Path, lines: Sequence[Line]) -> int:
    """Count the rows above the numbers: one of names and at most one of units."""
    count = next((i for i, line in enumerate(lines) if _has_number(line)), len(lines))
    if count == 0:
        raise DataError(
            f"{path}, line {lines[0].number}: the first row holds numbers; "
            "a header row with the names of the columns must come first."
        )
    if count > 2:
        raise DataError(
            f"{path}, line {lines[2].number}: given text {lines[2].cells}; above the numbers only "
            "a row of names and a row of units may stand. Delete the other rows; if they hold "
            "numbers, set their cells apart by comma, semicolon or tab."
        )
    if count == len(lines):
        raise DataError(
            f"{path}: the file holds a header and no numbers; rows of numbers must follow it, "
            "their cells set apart by comma, semicolon or tab."
        )
    return count


def _trim_rows(path: Path, lines: Sequence[Line], width: int) -> list[Line]:
    rows = [Line(line.number, trim(line.cells, width)) for line in lines]
    for row in rows:
        if not any(row.cells):
            raise DataError(
                f"{path}, line {row.number}: this row is blank but numbers follow; delete it."
            )
        if len(row.cells) != width:
            raise ragged(path, row.number, len(row.cells), width)
    return rows


def _parse_row(path: Path, row: Line, names: Sequence[str]) -> list[float]:
    return [
        _parse_cell(path, row.number, name, cell)
        for name, cell in zip(names, row.cells, strict=True)
    ]


def _parse_cell(path: Path, line: int, name: str, cell: str) -> float:
    if not cell:
        return math.nan
    if is_number(cell) and math.isfinite(value := float(cell)):
        return value
    if _DECIMAL_COMMA.fullmatch(cell):
        raise DataError(
            f"{path}, line {line}, column '{name}': given '{cell}', a number with a decimal comma; "
            f"numbers take a decimal point, {cell.replace(',', '.')}. Save the file with points, "
            "or replace the commas."
        )
    raise DataError(
        f"{path}, line {line}, column '{name}': given '{cell}'; each cell must be a finite "
        "number with a decimal point. Cells are separated by comma, semicolon or tab. "
        "Correct the cell or delete its row."
    )
