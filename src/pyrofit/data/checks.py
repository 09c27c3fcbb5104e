"""Checks of a measured series: order, signs, and values that only a wrong unit explains."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.data.csvfile import FileTable, FloatArray
from pyrofit.errors import DataError
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import SCALES, unit_key

_TOO_LARGE = 1e30
TEMPERATURES_K = (150.0, 2500.0)
"""Limits of a temperature that is recorded beside a quantity."""
WHOLE = 1.05
"""Largest loss, as a fraction of the initial mass, with room for a drift."""
_NEAR_ZERO = 0.1
"""Largest first value of a change of mass, as a fraction of its fall."""
_FAR_BELOW_ZERO = 0.5
"""A mass that falls further below zero, as a fraction of its largest value, has a wrong zero."""


def check_finite(path: Path, frame: pd.DataFrame) -> None:
    """Refuse numbers that are too large once they are in SI units."""
    for column in frame:
        if (bad := np.flatnonzero(~(np.abs(frame[column].to_numpy(float)) < _TOO_LARGE))).size:
            raise DataError(
                f"{path}, point {bad[0] + 1}: {column} is too large a number in SI units; "
                "correct the file or the unit."
            )


def check_order(
    quantity: Quantity, table: FileTable, headers: Mapping[str, str], frame: pd.DataFrame
) -> None:
    """Refuse unordered times, negative uncertainties, crossed limits, a loss of the wrong sign."""
    time = frame["time_s"].to_numpy()
    if "time" in headers and time[0] < 0.0:
        rule = "time starts at 0 or later. Delete the rows before 0."
        raise _refusal(table, headers["time"], 0, rule)
    if "time" in headers and (stops := np.flatnonzero(np.diff(time) <= 0.0)).size:
        row = int(stops[0]) + 1
        rule = f"time must exceed that of the row before. {_way_out(time, row)}"
        raise _refusal(table, headers["time"], row, rule)
    if "uncertainty" in headers:
        uncertainty = frame[quantity.uncertainty_column].to_numpy()
        if uncertainty.min() < 0.0:
            rule = (
                "an uncertainty is never negative. Correct it, or give `uncertainty` as a number."
            )
            raise _refusal(table, headers["uncertainty"], int(uncertainty.argmin()), rule)
    if "lower" in headers:
        lower, upper = (frame[column].to_numpy() for column in quantity.limit_columns.values())
        if (crossed := np.flatnonzero(lower > upper)).size:
            rule = "the lower limit lies above the upper one. Exchange the two columns."
            raise _refusal(table, headers["lower"], int(crossed[0]), rule)
    value = frame[quantity.column].to_numpy()
    ratio = quantity.sign_ratio
    if ratio is not None and -value.min() > ratio * value.max():
        rule = f"a {quantity.title} is positive. Change the sign of the column."
        raise _refusal(table, headers["value"], int(value.argmin()), rule)


def _way_out(time: FloatArray, row: int) -> str:
    """Return how times that do not rise at a row are mended."""
    steps = np.diff(time)
    if (steps <= 0.0).all():
        return "The rows stand in reverse order; turn them round."
    if time[row] <= time[0] and row > 2 and (steps[row:] > 0.0).any():
        return (
            "The times start anew, as of a second test or segment. Give each test a file of its "
            "own, or delete the rows of the other."
        )
    if (steps >= 0.0).all():
        return (
            f"{(steps == 0.0).sum()} rows are so: the times are rounded. Write them with more "
            "digits, or delete doubled rows."
        )
    return "Sort the rows and delete doubled ones."


def check_limits(
    quantity: Quantity, table: FileTable, headers: Mapping[str, str], frame: pd.DataFrame
) -> None:
    """Refuse temperatures, rates and mass fractions that only a wrong unit explains."""
    checked = [("value", quantity.column, quantity.largest, quantity.all_within)]
    if quantity.against_temperature:
        checked.insert(0, ("temperature", "temperature_K", TEMPERATURES_K, True))
    for role, column, (low, high), every in checked:
        numbers = frame[column].to_numpy()
        rows = (numbers.argmin(), numbers.argmax()) if every else (numbers.argmax(),)
        for row in map(int, rows):
            if not low <= numbers[row] <= high:
                rule = (
                    f"{column} is then {numbers[row]:g}, not between {low:g} and {high:g}. If the "
                    f"unit is wrong, give the right one in the study: `units: {{{role}: ...}}` "
                    "(degrees Celsius: degC), else check the mass and area of the sample."
                )
                raise _refusal(table, headers[role], row, rule)


def is_change(mass: FloatArray) -> bool:
    """Tell whether a column is a change of mass: it starts near 0 and falls below.

    >>> is_change(np.array([0.1, 0.0, -40.0, -80.0])), is_change(np.array([100.0, 60.0, -0.5]))
    (True, False)
    """
    lowest, largest = float(mass.min()), float(mass.max())
    falls = lowest < 0.0 and -lowest > _FAR_BELOW_ZERO * largest
    return falls and abs(float(mass[0])) <= -_NEAR_ZERO * lowest


def check_zero(
    quantity: Quantity,
    table: FileTable,
    headers: Mapping[str, str],
    unit: str | None,
    sign: int = 1,
) -> None:
    """Refuse the change of a mass, and a mass far below zero; noise about zero is allowed.

    A change in units of a fraction is read, see `pyrofit.data.convert`.

    Parameters
    ----------
    quantity
        The quantity; only masses and their fractions are checked.
    table, headers
        The file, without rows that hold no value, and its columns by role.
    unit
        Unit of the value.
    sign
        Sign of the file's values.
    """
    if "mass" not in quantity.scales:
        return
    mass = sign * table.columns[headers["value"]]
    row = int(mass.argmin())
    first, lowest, largest = float(mass[0]), float(mass[row]), float(mass.max())
    if -lowest <= _FAR_BELOW_ZERO * largest or lowest >= 0.0:
        return
    if is_change(mass):
        fractions = {unit_key(word): factor for word, factor in SCALES["fraction"].items()}
        if lowest * fractions.get(unit_key(unit or ""), np.inf) >= -WHOLE:
            return
        whole = f"the initial mass in {unit}" if unit else "that at first"
        rule = (
            f"the column starts near 0, at {first:g}, and falls: this looks like a change of "
            f"mass. Add {whole} to the column, give a column of the mass itself, or give "
            "`sample_mass_kg` to a heated sample whose column is in mg."
        )
    else:
        rule = (
            f"a mass is not that far below 0; its largest value is {largest:g}. Subtract the "
            "blank curve or correct the zero of the balance."
        )
    raise _refusal(table, headers["value"], row, rule)


def _refusal(table: FileTable, header: str, row: int, rule: str) -> DataError:
    return DataError(
        f"{table.path}, line {table.line(row)}, column '{header}': "
        f"given {table.columns[header][row]:g}; {rule}"
    )
