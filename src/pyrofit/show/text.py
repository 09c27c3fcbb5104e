"""Numbers, lists and tables as text."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence

import pandas as pd


def number(value: object) -> str:
    """Write a number to four significant digits, one decimal at least; text stays as it is.

    >>> [number(v) for v in (1199.7133, 0.0877472, 600.0, 2.0632e16, 7, float("nan"))]
    ['1199.7', '0.08775', '600', '2.063e+16', '7', '']
    """
    if value is None or isinstance(value, str):
        return value or ""
    if not isinstance(value, (int, float)):
        return str(value)
    if isinstance(value, bool) or (isinstance(value, float) and math.isnan(value)):
        return ("yes" if value else "no") if isinstance(value, bool) else ""
    size = abs(value)
    if size == 0.0 or (1e-4 <= size < 1e6 and float(f"{value:.4g}") == value):
        return f"{value:g}" if isinstance(value, float) else str(value)
    if isinstance(value, int):
        return str(value)
    if not 1e-4 <= size < 1e6:
        return f"{value:.3e}"
    return f"{value:.{max(1, 3 - math.floor(math.log10(size)))}f}"


def typeset(text: str) -> str:
    r"""Set a text for a page: raise the powers of metres, keep a number and its unit together.

    >>> typeset("6.9 kg/m3, 8 % of the mean")
    '6.9\xa0kg/m³, 8\xa0% of the mean'
    """
    raised = re.sub(r"(?<=[/( ])m([23])\b", lambda power: "m" + "²³"[int(power[1]) - 2], text)
    return re.sub(
        r"(?<=\d) (?=%|°C|(?:K|s|sd|mm)\b|[A-Za-z]+/)|(?<=[\w²]) (?=[Ks]\))", "\xa0", raised
    )


def plain_rows(frame: pd.DataFrame) -> list[list[object]]:
    """Return the cells as Python's own types, missing ones as None."""
    columns = [frame[name].astype(object).tolist() for name in frame.columns]
    rows = [list(row) for row in zip(*columns, strict=True)]
    return [[None if _missing(cell) else cell for cell in row] for row in rows]


def _missing(cell: object) -> bool:
    return isinstance(cell, float) and math.isnan(cell)


def groups(frame: pd.DataFrame, by: str | None) -> Iterator[tuple[str, pd.DataFrame]]:
    """Split a table by a column, in order of appearance; columns empty in a part are dropped."""
    if by is None:
        yield "", frame
        return
    for value in frame[by].unique():
        part = frame[frame[by] == value].drop(columns=by)
        yield str(value), part.dropna(axis="columns", how="all")


def turned(frame: pd.DataFrame, by: str, headings: Mapping[str, str]) -> pd.DataFrame:
    """Turn rows into columns: the values of ``by`` become the headings."""
    turned = frame.astype(object).set_index(by).T
    turned.insert(0, "quantity", [headings.get(str(name), str(name)) for name in turned.index])
    turned.columns.name = None
    return turned.reset_index(drop=True)


def markdown(frame: pd.DataFrame) -> str:
    """Return a table as Markdown.

    >>> print(markdown(pd.DataFrame({"a": ["x"], "b [K]": [1.5]})), end="")
    | a | b [K] |
    |:--|--:|
    | x | 1.5 |
    """
    lines = ["| " + " | ".join(frame.columns) + " |"]
    lines.append("|" + "|".join("--:" if numeric(frame[c]) else ":--" for c in frame) + "|")
    lines += [
        "| " + " | ".join(number(cell).replace("|", "\\|") for cell in row) + " |"
        for row in plain_rows(frame)
    ]
    return "\n".join(lines) + "\n"


def numeric(column: pd.Series) -> bool:
    """Tell whether a column holds numbers, which stand to the right."""
    return bool(pd.api.types.is_numeric_dtype(column) and not pd.api.types.is_bool_dtype(column))


def listed(words: Sequence[str]) -> str:
    """Join words as in a sentence.

    >>> listed(["a", "b", "c"])
    'a, b and c'
    """
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def span(values: Sequence[float] | pd.Series) -> str:
    """Write the smallest and the largest of some numbers.

    >>> span([0.38129, 0.35265])
    '0.353 to 0.381'
    >>> span([19.0, 100.2])
    '19.0 to 100'
    """
    low, high = (f"{value:#.3g}".rstrip(".") for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def several(count: int, word: str) -> str:
    """Write a number of things.

    >>> several(1, "point"), several(3, "point")
    ('1 point', '3 points')
    """
    return f"{count} {word}" + ("" if count == 1 else "s")


def signed(value: float) -> str:
    """Write a number with its sign and two digits.

    >>> signed(-0.83), signed(-0.001)
    ('−0.83', '+0.00')
    """
    return f"{round(value, 2) + 0.0:+.2f}".replace("-", "−")
