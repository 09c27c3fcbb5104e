"""What is suspect in a record that can be read: it is told, and the record is used as it is."""

from collections.abc import Callable

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pyrofit.data.csvfile import FloatArray
from pyrofit.data.heating import COOLED_K, end_of_heating
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import ICE_POINT_K

LOOK = "look at this record: "
"""Beginning of the note on a suspect record."""
ROOM_K = (283.0, 323.0)
"""Temperatures at which records usually start."""
ROOM_F = (60.0, 122.0)
"""The same in degrees F, beyond those in degrees C."""
STANDARD_RATES = np.array([1, 2, 3, 5, 10, 15, 20, 25, 30, 40, 50, 80, 100.0])
_SAME_RATE = 0.02
COLD_K = 268.0
"""A record that starts below this is seldom one of a fire test."""
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
_HEAT_FLOW_W_KG = (20.0, 2e4)
"""Largest heat flows that are usual."""
_RATES, _RAMP_K, _PARTS = (0.2, 150.0), 200.0, 40
"""Heating rates [K/min] beyond which a unit is suspect; a ramp; parts of a record with a slope."""
FRONT_K = 60.0
"""Rise of a temperature within the first 5 % of a test that only the exposed face shows."""
FEWEST_POINTS = 40
"""Points of a record of which that can be told."""
_LATE_K, _LATE_LOSS = (800.0, 900.0), 0.032
"""Temperatures between which char hardly loses mass, and a loss over the initial mass that is more
than that. 66 records of wood in nitrogen lose 0.013 to 0.027; 11, of leaks it seems, 0.037 to
0.109."""
_PYROLYSED = 0.7
"""Mass that is left at most once most has pyrolysed, over the initial one."""
_GAP, _GAP_SHARE = 5.0, 0.02
"""A gap is this many usual long steps, and this share of the record."""


def suspicions(
    quantity: Quantity, frame: pd.DataFrame, in_K: bool = False, in_oxygen: bool = False
) -> list[str]:
    """Return notes on what is suspect in a record, each with the way out.

    Parameters
    ----------
    quantity
        The measured quantity.
    frame
        The series in SI units, as `pyrofit.data.series.read_series` returns it.
    in_K
        Whether its temperatures are in K in the file.
    in_oxygen
        Whether the gas holds oxygen, as the study says.

    Examples
    --------
    >>> from pyrofit.quantities import known_quantities
    >>> t = np.arange(0.0, 600.0)
    >>> frame = pd.DataFrame({"time_s": t, "temperature_K": 300 + t, "mass_fraction": 0 * t + 1})
    >>> suspicions(known_quantities()["mass_fraction"], frame)[0][21:55]
    'the mass falls by no more than 0 %'
    """
    checks: tuple[Callable[[Quantity, pd.DataFrame], str], ...] = (
        _cold,
        *(() if in_K else (_warm,)),
        _rate,
        _mass,
        _jumps,
        _first,
        _heat,
        _cycles,
        *(() if in_oxygen else (_lost_char,)),
        _place,
        _gap,
        _end,
    )
    said = (check(quantity, frame) for check in checks)
    return [f"{LOOK}{text}" for text in said if text]


def _temperature(quantity: Quantity, frame: pd.DataFrame) -> FloatArray | None:
    if quantity.against_temperature:
        return frame["temperature_K"].to_numpy(float)
    return frame[quantity.column].to_numpy(float) if quantity.is_temperature else None


def _cold(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a record in degrees C that is taken for K."""
    temperature = _temperature(quantity, frame)
    if temperature is None or temperature[0] >= COLD_K:
        return ""
    return (
        f"it starts at {temperature[0]:.0f} K, below room temperature. If the column is in degrees "
        f"C, give `units: {{{_role(quantity)}: degC}}`"
    )


def _role(quantity: Quantity) -> str:
    """Return the role of the column of temperatures."""
    return "temperature" if quantity.against_temperature else "value"


def _warm(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a record in K that is taken for degrees C."""
    temperature = _temperature(quantity, frame)
    if temperature is None:
        return ""
    first = float(temperature[0])
    if ROOM_K[0] <= first - ICE_POINT_K <= ROOM_K[1]:
        return (
            f"it starts at {first:.0f} K. If the column is in K, so that it starts at "
            f"{first - ICE_POINT_K:.0f} K, give `units: {{{_role(quantity)}: K}}`"
        )
    return ""


def _rate(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find times in another unit than that of their column: a rate that is 60 or 3600 times off."""
    if not quantity.against_temperature:
        return ""
    time, temperature = (frame[c].to_numpy(float) for c in ("time_s", "temperature_K"))
    some = np.unique(np.linspace(0, time.size - 1, _PARTS).astype(int))
    slopes = 60.0 * np.diff(temperature[some]) / np.diff(time[some])
    usual, largest = float(np.median(slopes)), float(slopes.max())
    if np.ptp(temperature) > _RAMP_K and largest < _RATES[0]:
        return (
            f"it heats by {largest:.3g} K/min at most. If its times are in seconds, give "
            "`units: {time: s}`"
        )
    if usual <= _RATES[1]:
        return _fahrenheit(float(temperature[0]) - ICE_POINT_K, usual)
    unit, least = ("min", 60.0) if usual / 60.0 <= _RATES[1] else ("h", 3600.0)
    return (
        f"it heats by {usual:.4g} K/min, by {usual / least:.3g} K/min if its times are in "
        f"{unit}. Then give `units: {{time: {unit}}}`"
    )


def _fahrenheit(first_C: float, K_min: float) -> str:
    """Find degrees F that are taken for degrees C: a warm start, and 1.8 times a usual rate."""
    off, of_F = (np.abs(rate / STANDARD_RATES - 1.0).min() for rate in (K_min, K_min / 1.8))
    if not ROOM_F[0] <= first_C <= ROOM_F[1] or of_F > _SAME_RATE or off < 3.0 * _SAME_RATE:
        return ""
    return (
        f"it starts at {first_C:.0f} °C and heats by {K_min:.3g} K/min, which would be "
        f"{K_min / 1.8:.3g} K/min if the column is in °F. Then give `units: {{temperature: degF}}`"
    )


def _smooth(values: FloatArray) -> FloatArray:
    rows = min(_SMOOTHED, max(values.size // _SHARE, 1))
    return np.asarray(pd.Series(values).rolling(rows).median().dropna(), float)


def _is_mass(quantity: Quantity) -> bool:
    return "mass" in quantity.scales


def _mass(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a mass that does not fall, that rises, or that ends below zero."""
    if not _is_mass(quantity):
        return ""
    mass = _smooth(frame[quantity.column].to_numpy(float))
    first, end, top = float(mass[0]), float(mass[-1]), float(mass.max())
    if first <= _LEAST_FALL * top:  # a loss, see `_first`
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


def _jumps(quantity: Quantity, frame: pd.DataFrame) -> str:
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


def _heat(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a heat flow of a size that no sample has."""
    if not quantity.has_sign:
        return ""
    largest = float(frame[quantity.column].abs().max())
    if _HEAT_FLOW_W_KG[0] <= largest <= _HEAT_FLOW_W_KG[1]:
        return ""
    return (
        f"the heat flow reaches {largest / 1e3:.3g} W/g, where 0.02 to 20 W/g are usual. Check its "
        "unit and the mass of the sample"
    )


def _first(quantity: Quantity, frame: pd.DataFrame) -> str:
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


def _end(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a cooling or a burn-off behind the heating."""
    if not quantity.against_temperature:
        return ""
    end = end_of_heating(frame, quantity)
    return "" if end is None else f"at {end.time_s:g} s, {end.why}. Give `until_s: {end.time_s:g}`"


def _gap(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a part that was not recorded."""
    time = frame["time_s"].to_numpy(float)
    steps = np.diff(time)
    usual = float(np.sort(steps)[int(0.95 * (steps.size - 1))])
    at = int(steps.argmax())
    if steps[at] < max(_GAP * usual, _GAP_SHARE * (time[-1] - time[0])):
        return ""
    if at == 0 and quantity.against_temperature and _is_of_equal_rise(frame["temperature_K"]):
        return ""  # heating begins slowly
    return (
        f"no point of the {quantity.title} lies between {time[at]:g} s and {time[at + 1]:g} s, "
        f"where steps are {usual:.3g} s elsewhere. The fit tells nothing of this gap; complete the "
        "record where you can"
    )


def _is_of_equal_rise(temperature: pd.Series) -> bool:
    """Tell whether a record has a point for each rise by some temperature, the first included."""
    rises = np.abs(np.diff(temperature.to_numpy(float)))
    median, usual = np.quantile(rises, (0.5, 0.95))
    return bool(median > 0.5 * usual and rises[0] < _GAP * usual)


def _cycles(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a heat flow of several heatings: the sample changes from one to the next."""
    if not (quantity.against_temperature and quantity.has_sign):
        return ""
    temperature = frame["temperature_K"].to_numpy(float)
    falls = float((np.maximum.accumulate(temperature) - temperature).max())
    if falls <= COOLED_K:
        return ""
    return (
        f"it is no single heating: the temperature falls by {falls:.0f} K within it. Keep the rows "
        "of one heating, and note which one"
    )


def _lost_char(quantity: Quantity, frame: pd.DataFrame) -> str:
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


def early_rise_K(time_s: FloatArray, temperature_K: FloatArray) -> float:
    """Return the rise [K] of a temperature within the first 5 % of a test."""
    early = time_s <= time_s[0] + 0.05 * (time_s[-1] - time_s[0])
    return float(temperature_K[early].max() - temperature_K[0])


def _place(quantity: Quantity, frame: pd.DataFrame) -> str:
    """Find a temperature taken for that of the back that rises as the front does."""
    if not quantity.before_backing or len(frame) < FEWEST_POINTS:
        return ""
    rise = early_rise_K(frame["time_s"].to_numpy(float), frame[quantity.column].to_numpy(float))
    if rise <= FRONT_K:
        return ""
    return (
        f"it rises by {rise:.0f} K in the first 5 % of the test, as the front does. If it was "
        "measured there, the signal is the front temperature: name it so"
    )
