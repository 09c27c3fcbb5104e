"""Checks of a measured series: order, signs, and values that only a wrong unit explains."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.data.csvfile import Table
from pyrofit.data.quantities import UNCERTAINTY_COLUMN, VALUE_COLUMN
from pyrofit.errors import DataError

_SIGN_RATIO = 3.0
_TOO_LARGE = 1e30
# Values outside betray a wrong unit, not a strange sample. A temperature must lie between the two
# at all times, the others at their largest: a sample ends without mass and without loss of mass.
_LIMITS = {
    "temperature_K": (200.0, 2500.0),
    "back_temperature_K": (200.0, 2500.0),
    "mlr_kg_m2_s": (0.0, 2.0),
    "mass_fraction": (0.5, 1.5),
}


def check_finite(path: Path, frame: pd.DataFrame) -> None:
    """Refuse numbers that are too large once they are in SI units."""
    for column in frame:
        if (bad := np.flatnonzero(~(np.abs(frame[column].to_numpy(float)) < _TOO_LARGE))).size:
            raise DataError(
                f"{path}, point {bad[0] + 1}: {column} is too large a number in SI units; "
                "correct the file or the unit."
            )


def check_order(
    quantity: str, table: Table, headers: Mapping[str, str], frame: pd.DataFrame
) -> None:
    """Refuse times that do not increase, negative uncertainties and a loss of the wrong sign."""
    time = frame["time_s"].to_numpy()
    if time[0] < 0.0:
        rule = "time starts at 0 or later. Delete the rows before 0."
        raise _refusal(table, headers["time"], 0, rule)
    if (stops := np.flatnonzero(np.diff(time) <= 0.0)).size:
        rule = "time must exceed that of the row before. Sort the rows and delete doubled ones."
        raise _refusal(table, headers["time"], int(stops[0]) + 1, rule)
    if "uncertainty" in headers:
        uncertainty = frame[UNCERTAINTY_COLUMN[quantity]].to_numpy()
        if uncertainty.min() < 0.0:
            rule = (
                "an uncertainty is never negative. Correct it, or give `uncertainty` as a number."
            )
            raise _refusal(table, headers["uncertainty"], int(uncertainty.argmin()), rule)
    value = frame[VALUE_COLUMN[quantity]].to_numpy()
    if quantity == "mlr" and -value.min() > _SIGN_RATIO * value.max():
        rule = "a mass loss rate is positive where mass is lost. Change the sign of the column."
        raise _refusal(table, headers["value"], int(value.argmin()), rule)


def check_limits(
    quantity: str, table: Table, headers: Mapping[str, str], frame: pd.DataFrame
) -> None:
    """Refuse temperatures, rates and mass fractions that only a wrong unit explains."""
    for role, column in (("temperature", "temperature_K"), ("value", VALUE_COLUMN[quantity])):
        if column not in frame:
            continue
        numbers = frame[column].to_numpy()
        low, high = _LIMITS[column]
        rows = (
            (numbers.argmin(), numbers.argmax()) if column.endswith("_K") else (numbers.argmax(),)
        )
        for row in map(int, rows):
            if not low <= numbers[row] <= high:
                rule = (
                    f"{column} is then {numbers[row]:g}, not between {low:g} and {high:g}. If the "
                    f"unit is wrong, give the right one in the study: `units: {{{role}: ...}}` "
                    "(degrees Celsius: degC), else check the mass and area of the sample."
                )
                raise _refusal(table, headers[role], row, rule)


def _refusal(table: Table, header: str, row: int, rule: str) -> DataError:
    return DataError(
        f"{table.path}, line {table.first_row + row}, column '{header}': "
        f"given {table.columns[header][row]:g}; {rule}"
    )
