"""How lists and ranges of numbers are written in sentences."""

from collections.abc import Sequence

import pandas as pd


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
