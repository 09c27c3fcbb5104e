"""Tables as text and as HTML, with numbers of four digits."""

from collections.abc import Iterable
from html import escape

import pandas as pd

from pyrofit.show.text import number, numeric, plain_rows

Part = tuple[str, pd.DataFrame]
"""Heading and table."""


def text_table(frame: pd.DataFrame, indent: str = "  ") -> str:
    """Return a table as text in columns.

    >>> print(text_table(pd.DataFrame({"name": ["k"], "value": [0.20587]})))
      name  value
      k     0.2059
    """
    rows = [list(map(str, frame.columns)), *_cells(frame)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = ("  ".join(f"{c:{w}}" for c, w in zip(row, widths, strict=True)) for row in rows)
    return "\n".join(f"{indent}{line}".rstrip() for line in lines)


def html_page(title: str, parts: Iterable[Part], lines: Iterable[str] = ()) -> str:
    """Return tables under a title as HTML for a notebook."""
    text = [f"<div><b>{escape(title)}</b>"]
    text += [f"<p>{escape(line)}</p>" for line in lines]
    for heading, frame in parts:
        text += [f"<p><i>{escape(heading)}</i></p>"] if heading else []
        text.append(_html_table(frame))
    return "\n".join([*text, "</div>"])


def _html_table(frame: pd.DataFrame) -> str:
    right = [numeric(frame[name]) for name in frame]
    rows = [_row("td", cells, right) for cells in _cells(frame)]
    head = _row("th", list(map(str, frame.columns)), right)
    return "\n".join(["<table>", f"<thead>{head}</thead>", "<tbody>", *rows, "</tbody></table>"])


def _row(tag: str, cells: list[str], right: list[bool]) -> str:
    sides = ("right" if is_right else "left" for is_right in right)
    made = (
        f'<{tag} style="text-align:{side}; padding:1px 8px">{escape(cell)}</{tag}>'
        for side, cell in zip(sides, cells, strict=True)
    )
    return f"<tr>{''.join(made)}</tr>"


def _cells(frame: pd.DataFrame) -> list[list[str]]:
    return [[number(cell) for cell in row] for row in plain_rows(frame)]
