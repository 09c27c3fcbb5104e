"""Friedman 1964: from the rates at equal conversion.

ln(dx/dt) = ln(A f(x)) - E/(R T), at every level of conversion x; doi 10.1002/polc.5070060121. Any
heating programme will do.
"""

import numpy as np

from pyrofit.analysis.isoconversional.levels import RecordsAtLevels
from pyrofit.analysis.isoconversional.line import Energies, Points, slopes
from pyrofit.constants import GAS_CONSTANT
from pyrofit.numerics import functions


def friedman(runs: RecordsAtLevels, temperature_sd_K: float) -> Energies:
    """Return E [J/mol] of records at levels of conversion.

    Parameters
    ----------
    runs
        The records.
    temperature_sd_K
        Standard deviation of the temperature of a record.
    """
    temperature, rate = runs.stacked("temperature_K"), runs.stacked("rate")
    x = 1.0 / (GAS_CONSTANT * temperature)
    y = functions.log(rate)
    first = slopes(Points(x, y, np.zeros(x.shape)), runs.groups)
    # A shift of the time at which a level is reached moves the temperature there as well.
    shift = runs.stacked("heating_K_s") * runs.stacked("time_sd")
    per_kelvin = first.value * x / temperature
    of_rate = runs.stacked("log_rate_sd")
    square = of_rate * of_rate
    square = square + per_kelvin * per_kelvin * (shift * shift + temperature_sd_K**2)
    return slopes(Points(x, y, np.sqrt(square)), runs.groups)
