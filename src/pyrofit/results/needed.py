"""Required contents of a file of results, and the refusal of one without them."""

import math
from pathlib import Path
from typing import Any

import pandas as pd

from pyrofit.errors import DataError

Keys = tuple[str, ...]
EACH = "*"
"""Among keys: every item of a list."""
AGAIN = "delete it and run again"
_KINDS = {float: "a finite number", dict: "a mapping", list: "a list", str: "text"}


def check_value(path: Path, part: Any, keys: Keys, kind: type, place: str = "") -> None:
    """Refuse a result that lacks the value at the end of some keys, or has one of another type."""
    if not keys:
        number = isinstance(part, int | float) and not isinstance(part, bool)
        if not (number and math.isfinite(part) if kind is float else isinstance(part, kind)):
            raise DataError(f"{path}: '{place}' is not {_KINDS[kind]}; {AGAIN}")
        return
    key, *rest = keys
    if key == EACH:
        if not isinstance(part, list) or not part:
            raise DataError(f"{path}: '{place}' is not a list of at least one; {AGAIN}")
        for i, item in enumerate(part):
            check_value(path, item, tuple(rest), kind, f"{place}.{i}")
        return
    place = f"{place}.{key}".removeprefix(".")
    if not isinstance(part, dict) or key not in part:
        raise DataError(f"{path}: '{place}' is missing in this result; {AGAIN}")
    check_value(path, part[key], tuple(rest), kind, place)


def check_rows(path: Path, frame: pd.DataFrame, names: Keys, wanted: list[Keys]) -> None:
    """Refuse a table that lacks some rows, or has others."""
    if absent := [name for name in names if name not in frame]:
        raise DataError(f"{path}: the column '{absent[0]}' is missing; {AGAIN}")
    found = set(frame[list(names)].itertuples(index=False, name=None))
    for row in sorted(found ^ set(wanted), key=str):
        what = "is of another study" if row in found else "is missing"
        named = ", ".join(f"{n} '{value}'" for n, value in zip(names, row, strict=True))
        raise DataError(f"{path}: the row of {named} {what}; {AGAIN}")
