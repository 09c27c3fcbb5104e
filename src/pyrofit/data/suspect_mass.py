"""What is suspect in the record of a mass: its start, its course, its end."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pyrofit.data.csvfile import FloatArray
from pyrofit.quantities.base import Quantity

_LEAST_FALL, _LEAST_RISE, FALLEN, _ABOVE = 0.01, 0.05, 0.97, 1.02
"""Changes of the mass, and a first value, as fractions of the initial mass."""
_BUOYANCY = 0.005
"""Rise of the mass of a heated sample over the initial one that a correction leaves seldom."""
_BELOW_ZERO = -0.1
"""Mass over the initial one that no drift of a sound balance reaches: 22 records of burnt slabs end
at -0.003 to -0.05, one at -0.15."""
_HEAVY, _FEW = 20.0, 0.3
"""Mass [kg/m2] of a thick slab, and a share of it that seems small beside one that burns."""
_SMOOTHED, _SHARE = 9, 20
"""Rows of a median, and the part of a record that they are at most: 1/20. A digitised curve may
have 14 rows."""
JUMP = 0.1
"""Share of the initial mass that no step of a record loses and takes back."""
_WINDOW = 5
"""Rows on each side of the median about which a value stands out."""
_LATE_K, _LATE_LOSS = (800.0, 900.0), 0.032
"""Temperatures between which char hardly loses mass, and a loss over the initial mass that is more
than that. 66 records of wood in nitrogen lose 0.013 to 0.027; 11, of leaks it seems, 0.037 to
0.109."""
_PYROLYSED = 0.7
"""Mass that is left at most once most has pyrolysed, over the initial one."""


def rows_of_median(points: int) -> int:
    """Return how many rows have a median that stands for each of them."""
    return min(_SMOOTHED, max(points // _SHARE, 1))


def _smooth(values: FloatArray) -> FloatArray:
    rows = rows_of_median(values.size)
    return np.asarray(pd.Series(values).rolling(rows).median().dropna(), float)


def _is_mass(quantity: Quantity) -> bool:
    return "mass" in quantity.scales


def course(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a mass that does not fall, that rises, or that ends below zero."""
    if not _is_mass(quantity):
        return ""
    mass = _smooth(frame[quantity.column].to_numpy(float))
    first, end, top = float(mass[0]), float(mass[-1]), float(mass.max())
    if first <= _LEAST_FALL * top:  # a loss, see `first_value`
        return ""
    if top > (1.0 + _LEAST_RISE) * first:
        return (
            f"the mass rises by {100.0 * (top / first - 1.0):.0f} % of its start. Subtract the "
            "blank curve, or give the column of the mass of the sample"
        )
    if first - end < _LEAST_FALL * first:
        return (
            f"the mass falls by no more than {100.0 * max(1.0 - end / first, 0.0):.1g} %, so it "
            "shows no reaction. Give the column of the mass, or a longer record"
        )
    if quantity.against_temperature and top - first > max(
        _BUOYANCY * first, _noise(frame, quantity)
    ):
        return (
            f"the mass rises by {100.0 * (top / first - 1.0):.1f} % before it falls, as buoyancy "
            "makes it. Subtract a run with the empty crucible: the residue is off by as much"
        )
    if end < _BELOW_ZERO * first:
        way = "" if quantity.against_temperature else ", or give an `offset`"
        return (
            f"the mass ends {-100.0 * end / first:.0f} % of its start below zero: the balance "
            f"drifted, or its zero is wrong. Correct the drift{way}"
        )
    if quantity.scales[0] == "mass per area" and first > _HEAVY and first - end < _FEW * first:
        return (
            f"it starts at {first:.3g} kg/m2 and falls by {100.0 * (1.0 - end / first):.2g} %, as "
            "with its holder on the load cell. Give the mass of the sample alone, or an `offset`"
        )
    return ""


def _noise(frame: pd.DataFrame, quantity: Quantity) -> float:
    """Return five standard deviations of the points of a record."""
    steps = np.abs(np.diff(frame[quantity.column].to_numpy(float)))
    return float(5.0 * np.median(steps) / 0.954)  # the median of |N(0, 2)| is 0.954


def standing_out(values: FloatArray, least: float) -> NDArray[np.intp]:
    """Return the rows that differ from the median of those around them by more than ``least``.

    >>> standing_out(np.r_[np.ones(20), 1.5, np.ones(20)], 0.1)
    array([20])
    """
    if values.size < 2 * _WINDOW + 2:
        return np.zeros(0, np.intp)
    padded = np.pad(values, _WINDOW, mode="edge")
    around = np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * _WINDOW + 1), axis=1)
    return np.flatnonzero(np.abs(values - around) > least)


def jumps(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find values of a mass that jump and come back."""
    if not _is_mass(quantity):
        return ""
    mass = frame[quantity.column].to_numpy(float)
    usual = float(np.median(mass[:_SMOOTHED]))
    rows = standing_out(mass / usual, JUMP) if usual > 0.0 else np.zeros(0, np.intp)
    if not rows.size:
        return ""
    first = float(frame["time_s"].to_numpy(float)[rows[0]])
    many = (
        "1 value of the mass jumps and comes"
        if rows.size == 1
        else (f"{rows.size} values of the mass jump and come")
    )
    return f"{many} back, the first at {first:g} s. Delete such rows"


def first_value(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a mass fraction that does not start at 1, as of a sample that was dried before."""
    if quantity.scales[0] != "fraction" or not _is_mass(quantity):
        return ""
    smooth = _smooth(frame[quantity.column].to_numpy(float))
    first = float(smooth[0])
    if first > _ABOVE:
        return (
            f"it starts at {100.0 * first:.1f} % of the initial mass, the model at 100 %. Give "
            "`relative_to: first value`, or correct the mass of the sample"
        )
    if first > FALLEN:
        return ""
    if first < _LEAST_FALL < smooth[-1]:
        return (
            f"it starts at {100.0 * first:.1f} % of the initial mass and rises, as a loss of mass "
            "does. Make the mass a column, such as 100 minus a loss in %"
        )
    return (
        f"it starts at {100.0 * first:.1f} % of the initial mass, the model at 100 %. If "
        "the sample was dried or heated before, give `relative_to: first value`"
    )


def lost_char(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find char that is lost when nothing pyrolyses any more: in oxygen, or by a drift."""
    if not (quantity.against_temperature and quantity.scales[0] == "fraction"):
        return ""
    temperature, mass = (frame[c].to_numpy(float) for c in ("temperature_K", quantity.column))
    if "mass" not in quantity.scales or temperature.max() < _LATE_K[1]:
        return ""
    early, late = (mass[int(np.argmax(temperature >= T))] / mass[0] for T in _LATE_K)
    if early - late <= _LATE_LOSS or early > _PYROLYSED or late <= 0.0:
        return ""
    return (
        f"it loses {100.0 * (early - late):.2g} % of the mass from {_LATE_K[0]:.0f} to "
        f"{_LATE_K[1]:.0f} K, where the pyrolysis of wood and most plastics is over. Look for "
        "oxygen in the gas, a drift of the balance, or a filler that decomposes. Leave it out: "
        f"give `until_K: {_LATE_K[0]:.0f}`"
    )
