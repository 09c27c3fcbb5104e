"""The rows of names and units that stand above the numbers of a file."""

import re
from collections.abc import Sequence

from pyrofit.data.csvheading import all_bracketed, holds_units, is_number
from pyrofit.data.line import BLANKS, FileLine

_SIG = re.compile(r'\s*"?sig\d+"?\s*[\t,;:|=]\s*([^\t]+?)[\s,;|]*(?:\t.*)?', re.IGNORECASE)
_COMMENT = ("#", "%", "//", "!")
_WITH_UNIT = re.compile(r"[^()\[\]]+(?:\((?:[^()]|\([^()]*\))*\)|\[[^\[\]]*\])")


def heading_above(lines: Sequence[FileLine], first: int, delimiter: str) -> tuple[FileLine, ...]:
    """Return the rows of names and units right above the rows of numbers; nothing without them.

    Parameters
    ----------
    lines
        Lines of the file.
    first
        Position of the first row of numbers.
    delimiter
        The separator of the cells.
    """
    places = [i for i, cell in enumerate(lines[first].cells) if cell]
    width = len(places)
    above = [line for line in lines[:first] if any(line.cells)][-2:]
    if delimiter == BLANKS:
        above = [_in_columns(line, width) for line in above]
    if len(above) == 2 and _goes_on_below(above[0], above[1], places):
        return (_joined(above[0], above[1]),)
    if not above or not _fills(above[-1], width):
        return ()
    if len(above) == 2 and _fills(above[0], width) and any(map(holds_units, above)):
        names, units = above if not all_bracketed(above[0]) else above[::-1]
        if delimiter == BLANKS and (missing := len(names.cells) - len(units.cells)) > 0:
            # A counter in the first column has no unit, and blanks do not show it.
            units = FileLine(units.number, [*[""] * missing, *units.cells])
        return names, units
    return (above[-1],)


def signals_in(raw: Sequence[str]) -> tuple[FileLine, ...]:
    r"""Return the names that a preamble lists as `Sig1`, `Sig2` ...; nothing where it does not.

    >>> signals_in(["Nsig\t2", "Sig1\tTime (min)", "Sig2\tWeight (%)"])[0].cells
    ['Time (min)', 'Weight (%)']
    """
    named = [match[1] for text in raw if (match := _SIG.fullmatch(text))]
    return (FileLine(len(raw), [name.strip('" ') for name in named]),) if named else ()


def _fills(line: FileLine, width: int) -> bool:
    """Tell whether text fills the columns of rows; a counter may have no name."""
    filled = [cell for cell in line.cells if cell]
    return len(filled) >= max(width - 1, 2) and not any(map(is_number, filled))


def _in_columns(line: FileLine, width: int) -> FileLine:
    """Split a heading that blanks separate into one name a column; brackets end a column.

    A sign of a comment at its beginning is no name.
    """
    cells = list(line.cells)
    if cells[0] in _COMMENT and len(cells) > width:
        cells = cells[1:]
    if len(cells) <= width:
        return FileLine(line.number, cells)
    text = " ".join(cells)
    names: list[str] = []
    for cell in cells:
        inside = names and (_opened(names[-1]) or cell.startswith(("(", "[")))
        names = [*names[:-1], f"{names[-1]} {cell}"] if inside else [*names, cell]
    if len(names) != width:
        names = [name.strip() for name in _WITH_UNIT.findall(text)]
    return FileLine(line.number, names if len(names) == width else cells)


def _opened(text: str) -> bool:
    """Tell whether a bracket is not closed."""
    return text.count("(") > text.count(")") or text.count("[") > text.count("]")


def _goes_on_below(names: FileLine, rest: FileLine, places: Sequence[int]) -> bool:
    """Tell whether names stand in two rows: the second leaves a column of the first out."""
    both = [cell for line in (names, rest) for cell in line.cells if cell]
    if any(map(is_number, both)) or holds_units(names) or holds_units(rest):
        return False
    if not all(i < len(names.cells) and names.cells[i] for i in places):
        return False
    below = [i for i, cell in enumerate(rest.cells) if cell]
    return len(below) > 1 and set(below) < set(places)


def _joined(names: FileLine, rest: FileLine) -> FileLine:
    """Return the names of two rows, one below the other."""
    cells = [*rest.cells, *[""] * (len(names.cells) - len(rest.cells))]
    return FileLine(
        names.number,
        [f"{name} {more}".strip() for name, more in zip(names.cells, cells, strict=False)],
    )
