"""Required contents of a file of results, and the refusal of one without them."""

import math
from pathlib import Path
from typing import Any

import pandas as pd

from pyrofit.errors import DataError

Keys = tuple[str, ...]
AGAIN = "delete it and run again"
_KINDS = {float: "a finite number", dict: "a mapping", list: "a list", str: "text"}


def check_value(path: Path, content: Any, keys: Keys, kind: type) -> None:
    """Refuse a result that lacks the value at the end of some keys, or has one of another type."""
    for count, key in enumerate(keys, 1):
        if not isinstance(content, dict) or key not in content:
            place = ".".join(keys[:count])
            raise DataError(f"{path}: '{place}' is missing in this result; {AGAIN}")
        content = content[key]
    number = isinstance(content, int | float) and not isinstance(content, bool)
    if not (number and math.isfinite(content) if kind is float else isinstance(content, kind)):
        raise DataError(f"{path}: '{'.'.join(keys)}' is not {_KINDS[kind]}; {AGAIN}")


def check_rows(path: Path, frame: pd.DataFrame, names: Keys, wanted: list[Keys]) -> None:
    """Refuse a table that lacks some rows, or has others."""
    if absent := [name for name in names if name not in frame]:
        raise DataError(f"{path}: the column '{absent[0]}' is missing; {AGAIN}")
    found = set(frame[list(names)].itertuples(index=False, name=None))
    for row in sorted(found ^ set(wanted), key=str):
        what = "is of another study" if row in found else "is missing"
        named = ", ".join(f"{n} '{value}'" for n, value in zip(names, row, strict=True))
        raise DataError(f"{path}: the row of {named} {what}; {AGAIN}")
