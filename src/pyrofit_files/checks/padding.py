"""Cells that hold no measurement: placeholders, and rows that repeat at the end."""

import numpy as np

from pyrofit.new_study.reasons import NO_VALUES, PLACEHOLDER
from pyrofit_files.examined import Examined
from pyrofit_files.signals import in_time

_ROWS = 10
_SHARE = 0.02


def check_placeholders(seen: Examined) -> None:
    """Note columns that are zero throughout, and signals with empty cells."""
    table = seen.table
    assert table is not None
    for header, why in seen.left.items():
        if why in (NO_VALUES, PLACEHOLDER):
            text = "empty" if why == NO_VALUES else "zero throughout"
            seen.say("placeholder", "note", text, header)
    for signal in seen.signals.values():
        cells = table.columns.get(signal.header)
        if cells is not None and (absent := int(np.isnan(cells).sum())):
            text = f"{absent} of {cells.size} cells are empty"
            seen.say("gaps", "note", text, signal.header)


def check_padding(seen: Examined) -> None:
    """Look for a value that repeats at the end while others go on, or for zeros there."""
    for signal in in_time(seen):
        y = signal.y
        if y.size < 4 * _ROWS:
            continue
        changes = np.flatnonzero(np.diff(y) != 0.0)
        same = y.size - 1 - (int(changes[-1]) if changes.size else 0)
        if same > max(_ROWS, _SHARE * y.size) and np.ptp(y) > 0.0:
            text = f"the last {same} of {y.size} values are the same"
            seen.say("padding", "doubt", text, signal.header)
        elif y[-1] == 0.0 and abs(y[-2]) > 0.05 * np.ptp(y):
            seen.say("padding", "fault", "the last value is 0 all at once", signal.header)
