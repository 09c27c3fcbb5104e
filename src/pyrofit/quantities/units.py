"""Units of measured files, and how their spellings and those of headers are compared."""

import re

SCALES: dict[str, dict[str, float]] = {
    "time": {"s": 1.0, "min": 60.0, "h": 3600.0},
    "temperature": {
        "K": 1.0,
        "degC": 1.0,
        "°C": 1.0,
        "C": 1.0,
        "degF": 5.0 / 9.0,
        "°F": 5.0 / 9.0,
    },
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3},
    "area": {"m2": 1.0, "cm2": 1e-4, "mm2": 1e-6},
    "mass per area": {"kg/m2": 1.0, "g/m2": 1e-3, "g/cm2": 10.0, "mg/cm2": 1e-2},
    "mass": {"kg": 1.0, "g": 1e-3, "mg": 1e-6, "ug": 1e-9, "µg": 1e-9},
    "mass flux": {
        "kg/s/m2": 1.0,
        "g/s/m2": 1e-3,
        "mg/s/m2": 1e-6,
        "g/s/cm2": 10.0,
        "mg/s/cm2": 0.01,
        "kg/min/m2": 1.0 / 60.0,
        "g/min/m2": 1e-3 / 60.0,
        "mg/min/cm2": 0.01 / 60.0,
    },
    "mass rate": {
        "kg/s": 1.0,
        "g/s": 1e-3,
        "mg/s": 1e-6,
        "g/min": 1e-3 / 60.0,
        "mg/min": 1e-6 / 60.0,
    },
    "heat flux": {"W/m2": 1.0, "kW/m2": 1e3, "MW/m2": 1e6, "W/cm2": 1e4},
    "heat rate": {"W": 1.0, "kW": 1e3, "MW": 1e6},
    "heat transfer coefficient": {"W/(m2 K)": 1.0, "W/m2/K": 1.0, "kW/(m2 K)": 1e3},
    "specific power": {"W/kg": 1.0, "kW/kg": 1e3, "W/g": 1e3, "mW/mg": 1e3, "mW/g": 1.0},
    "power": {"W": 1.0, "mW": 1e-3, "uW": 1e-6, "µW": 1e-6, "kW": 1e3},
    "fraction": {"1": 1.0, "-": 1.0, "g/g": 1.0, "kg/kg": 1.0, "mg/mg": 1.0, "%": 0.01},
}
PER_AREA = {"mass rate": "mass flux", "mass": "mass per area", "heat rate": "heat flux"}
"""The kind of unit after division by the area of the sample."""
PER_START = {"mass": "fraction"}
"""The kind of unit after division by the initial value."""
PER_MASS = {"power": "specific power"}
"""The kind of unit after division by the mass of the sample."""
ICE_POINT_K = 273.15
_ZERO_F_K = 459.67 * 5.0 / 9.0
ZEROS_K = {
    "degC": ICE_POINT_K,
    "°C": ICE_POINT_K,
    "C": ICE_POINT_K,
    "degF": _ZERO_F_K,
    "°F": _ZERO_F_K,
}
"""Temperature [K] of the zero of a unit; 0 K where it is not listed."""


_SIGNS = str.maketrans(
    {"²": "2", "¹": "1", "−": "-", "⁻": "-", "º": "°", "℃": "°c", "℉": "°f", "\ufffd": "°"}
)
"""Signs of one meaning; a sign that was lost in an encoding, before C, was that of degrees."""


def unit_key(unit: str) -> str:
    """Reduce a unit to one spelling: `kg m-2 s-1`, `kg/(m^2 s)` and `kg/m²/s` to `kg/s/m2`.

    >>> {unit_key(unit) for unit in ("g/s.m2", "g/m^2-s", "g/m2.s", "g m-2 s-1")}
    {'g/s/m2'}
    """
    key = re.sub(r"[\s^*·⋅()\[\]]", "", unit.casefold()).translate(_SIGNS)
    key = re.sub(r"^(cel|celsius)$", "°c", key)
    key = re.sub(r"(c?m)-2", r"/\g<1>2", key)
    key = re.sub(r"([km]?g|s|min)-1", r"/\1", key)
    key = re.sub(r"/(s|min)[.-](c?m2)$", r"/\1/\2", key)
    key = re.sub(r"/(c?m2)[/.-]?(s|min)$", r"/\2/\1", key)
    return re.sub(r"/(s|min)(c?m2)$", r"/\1/\2", key)


def header_key(header: str) -> str:
    """Reduce a header to its distinctive part: no case, blanks, dashes, points or unit."""
    name = re.sub(r"\s*(\[.*\]|\(.*\))$", "", header)
    return re.sub(r"[\s_.-]", "", name).casefold()
