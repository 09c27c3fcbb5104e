"""What is suspect in a record that can be read: it is told, and the record is used as it is."""

from collections.abc import Callable

import numpy as np
import pandas as pd

from pyrofit.data import suspect_mass
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
_HEAT_FLOW_W_KG = (20.0, 2e4)
"""Largest heat flows that are usual."""
_RATES, _RAMP_K, _PARTS = (0.2, 150.0), 200.0, 40
"""Heating rates [K/min] beyond which a unit is suspect; a ramp; parts of a record with a slope."""
FRONT_K = 60.0
"""Rise of a temperature within the first 5 % of a test that only the exposed face shows."""
FEWEST_POINTS = 40
"""Points of a record of which that can be told."""
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
        suspect_mass.course,
        suspect_mass.jumps,
        suspect_mass.first_value,
        _heat,
        _cycles,
        *(() if in_oxygen else (suspect_mass.lost_char,)),
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
