"""The quantities that can be measured: columns, usual headers, units."""

import re

VALUE_COLUMN = {
    "mlr": "mlr_kg_m2_s",
    "back_temperature": "back_temperature_K",
    "mass_fraction": "mass_fraction",
}
"""Column of the measured value, with its unit, by quantity."""

UNCERTAINTY_COLUMN = {
    "mlr": "mlr_uncertainty_kg_m2_s",
    "back_temperature": "back_temperature_uncertainty_K",
    "mass_fraction": "mass_fraction_uncertainty",
}
"""Column of the uncertainty of the value, in the unit of the value, by quantity."""

_TIDY_UNITS = {"mlr": "kg/(m2 s)", "back_temperature": "K", "mass_fraction": "-"}

SCALES = {
    "time": {"s": 1.0, "min": 60.0, "h": 3600.0},
    "temperature": {"K": 1.0, "degC": 1.0, "°C": 1.0, "C": 1.0},
    "mass": {"kg": 1.0, "g": 1e-3, "mg": 1e-6},
    "mass flux": {"kg/s/m2": 1.0, "g/s/m2": 1e-3, "mg/s/m2": 1e-6},
    "mass rate": {"kg/s": 1.0, "g/s": 1e-3, "mg/s": 1e-6},
    "fraction": {"1": 1.0, "-": 1.0, "g/g": 1.0, "kg/kg": 1.0, "mg/mg": 1.0, "%": 0.01},
}
CELSIUS = {"degC", "°C", "C"}
ICE_POINT_K = 273.15

VALUE_KINDS = {
    "mlr": ("mass flux", "mass rate"),
    "back_temperature": ("temperature",),
    "mass_fraction": ("fraction", "mass"),
}

# The usual header names by role; `header_key` says which differences of spelling do not count.
HEADERS: dict[str, dict[str, tuple[str, ...]]] = {
    "mlr": {
        "time": ("Time",),
        "value": ("MLR_mean", "MLR", "Mass loss rate", "Mass flux"),
        "uncertainty": ("MLR_error", "MLR uncertainty", "Error", "Uncertainty"),
    },
    "back_temperature": {
        "time": ("Time",),
        "value": ("Temp_avg_all4", "Temperature", "Temp", "Back temperature"),
        "uncertainty": ("Temperature_Error", "Temp error", "Error", "Uncertainty"),
    },
    "mass_fraction": {
        "time": ("Time",),
        "temperature": ("Temperature", "Temp"),
        "value": ("Mass fraction", "Mass", "Normalized mass", "Normalised mass"),
        "uncertainty": ("Mass fraction error", "Mass error", "Error", "Uncertainty"),
    },
}


def tidy_keys(quantity: str) -> dict[str, dict[str, str]]:
    """Return ``columns`` and ``units`` of a signal whose file is a tidy table of the workflow's.

    >>> tidy_keys("mlr")["units"]
    {'time': 's', 'value': 'kg/(m2 s)', 'uncertainty': 'kg/(m2 s)'}
    """
    columns = {
        "time": "time_s",
        "value": VALUE_COLUMN[quantity],
        "uncertainty": UNCERTAINTY_COLUMN[quantity],
    }
    unit = _TIDY_UNITS[quantity]
    units = {"time": "s", "value": unit, "uncertainty": unit}
    if quantity == "mass_fraction":
        columns["temperature"], units["temperature"] = "temperature_K", "K"
    return {"columns": columns, "units": units}


def unit_key(unit: str) -> str:
    """Reduce a unit to one spelling: `kg m-2 s-1`, `kg/(m^2 s)` and `kg/m²/s` to `kg/s/m2`."""
    key = re.sub(r"[\s^*·⋅()\[\]]", "", unit.casefold()).replace("²", "2").replace("−", "-")
    key = key.replace("m-2", "/m2").replace("s-1", "/s")
    return re.sub(r"/m2/?s$|/sm2$", "/s/m2", key)


def header_key(header: str) -> str:
    """Reduce a header to what tells it from others: no case, blanks, dashes, points or unit."""
    name = re.sub(r"\s*(\[.*\]|\(.*\))$", "", header)
    return re.sub(r"[\s_.-]", "", name).casefold()
