"""Blocks of columns of the same names side by side, each below a label of its own."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Block:
    """Columns of one test: the label above them, and the name in the table by that of the file."""

    label: str
    columns: Mapping[str, str]


def blocks_below(
    cells: Sequence[str], given: Sequence[str], own: Sequence[str]
) -> tuple[Block, ...]:
    """Return the blocks of a table below a row of labels; nothing where they are not clear.

    Parameters
    ----------
    cells
        Cells of the row above the names. One that spreads over several columns stands in the
        first of them, or in each.
    given, own
        The names as the file writes them, empty where a column has none, and those of the table.

    Examples
    --------
    >>> names = ["T", "m", "T", "m"], ["T (1)", "m (1)", "T (2)", "m (2)"]
    >>> [(b.label, b.columns) for b in blocks_below(["5 K/min", "", "10 K/min"], *names)]
    [('5 K/min', {'T': 'T (1)', 'm': 'm (1)'}), ('10 K/min', {'T': 'T (2)', 'm': 'm (2)'})]
    >>> [b.label for b in blocks_below(["Rate (K/min)", "5", "", "10"], *names)]
    ['5 K/min', '10 K/min']
    >>> [b.label for b in blocks_below(["Rate:", "5", "", "10"], *names)]
    ['Rate 5', 'Rate 10']
    >>> blocks_below(["Sample of 5 mg", "", "", ""], *names)
    ()
    """
    first = next((name for name in given if name), None)
    starts = [i for i, name in enumerate(given) if name == first]
    ends = [*starts[1:], max(len(given), len(cells))]
    columns = [
        {name: own[i] for i, name in enumerate(given[start:end], start=start) if name}
        for start, end in zip(starts, ends, strict=True)
    ]
    if len(starts) < 2 or any(list(one) != list(columns[0]) for one in columns):
        return ()
    about = next((cell for cell in cells if cell and not _numbered(cell)), "")
    labels = [_label(cells[start:end], about) for start, end in zip(starts, ends, strict=True)]
    if not all(labels):
        return ()
    return tuple(Block(label, one) for label, one in zip(labels, columns, strict=True))


def _numbered(cell: str) -> bool:
    """Tell whether a cell holds a number, but for those of a unit such as kW/m2."""
    return re.search(r"(?<![A-Za-z^\d])\d", cell) is not None


def _label(cells: Sequence[str], about: str) -> str:
    """Return the one label with a number among cells; a number alone gets the words of the row."""
    found = {cell for cell in cells if _numbered(cell)}
    if len(found) != 1:
        return ""
    label = found.pop()
    if not about or not re.fullmatch(r"\d+(?:[.,]\d+)?", label):
        return label
    about = about.rstrip(" :=")
    unit = re.search(r"[\[(]([^\])]+)[\])]|(\S+/\S+)$", about)
    return f"{label} {unit[1] or unit[2]}" if unit else f"{about} {label}"
