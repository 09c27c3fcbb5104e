"""Kissinger, Akahira and Sunose: from the temperatures at equal conversion.

ln(b/T^2) = c - E/(R T), with the heating rate b, at every level of conversion: Kissinger 1957, doi
10.1021/ac60131a045; Akahira and Sunose 1971, Res. Report Chiba Inst. Technol. 16, 22. It is for
constant heating rates. It takes E as constant from the first conversion to the level: where E
varies, it gives a mean. Its integral is approximate: E is off by 2 (R T/E)^2, which is 1 % at
E/(R T) = 14 and less above.
"""

import numpy as np

from pyrofit.analysis.isoconversional.levels import RecordsAtLevels
from pyrofit.analysis.isoconversional.line import Energies, Points, slopes
from pyrofit.constants import GAS_CONSTANT
from pyrofit.numerics import functions


def kas(runs: RecordsAtLevels, temperature_sd_K: float) -> Energies:
    """Return E [J/mol] of the records of a constant heating rate, at levels of conversion.

    Parameters
    ----------
    runs
        The records; those without a constant rate do not count.
    temperature_sd_K
        Standard deviation of the temperature of a record.
    """
    constant = np.array([curve.rate_K_min is not None for curve in runs.curves])
    rate = np.array([_measured_rate(runs, i) for i in range(len(runs.curves))])
    temperature = np.where(constant[:, None], runs.stacked("temperature_K"), np.nan)
    x = 1.0 / (GAS_CONSTANT * temperature)
    y = functions.log(rate[:, None] / (temperature * temperature))
    first = slopes(Points(x, y, np.zeros(x.shape)), runs.groups)
    shift = rate[:, None] * runs.stacked("time_sd")
    per_kelvin = first.value * x / temperature + 2.0 / temperature
    sd = per_kelvin * np.sqrt(shift * shift + temperature_sd_K**2)
    return slopes(Points(x, y, sd), runs.groups)


def _measured_rate(runs: RecordsAtLevels, i: int) -> float:
    """Return the mean heating rate [K/s] of a record between its first and last level."""
    time, temperature = runs.at[i].time_s, runs.at[i].temperature_K
    known = np.flatnonzero(np.isfinite(time))
    if known.size < 2:
        return float("nan")
    first, last = known[0], known[-1]
    rise = float(temperature[last] - temperature[first])
    return rise / float(time[last] - time[first]) if rise > 0.0 else float("nan")
