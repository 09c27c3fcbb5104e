"""Heat release rate by oxygen consumption, from the records of a cone calorimeter."""

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

E_J_KG = 13.1e6
"""Heat released per mass of oxygen consumed [J/kg]."""
_MASS_RATIO = 1.10
"""Ratio of the molar masses of oxygen and air."""


def heat_release_rate(
    time_s: FloatArray,
    oxygen: FloatArray,
    pressure_Pa: FloatArray,
    stack_K: FloatArray,
    c_factor: float,
    ambient_oxygen: float,
    delay_s: float,
) -> FloatArray:
    r"""Return the heat release rate [W] by ISO 5660-1, where oxygen alone is measured.

        q(t) = 1.10 E C sqrt(dp(t) / T_e(t)) (x_0 - x(t + t_d)) / (1.105 - 1.5 x(t + t_d))

    Parameters
    ----------
    time_s, oxygen, pressure_Pa, stack_K
        Times, mole fractions of oxygen x, pressure differences dp of the orifice and gas
        temperatures T_e there, shape (n,).
    c_factor
        Calibration constant C of the orifice [m^0.5 kg^0.5 K^0.5].
    ambient_oxygen
        Mole fraction x_0 before the test.
    delay_s
        Delay t_d of the analyser [s]; behind the last time its last value holds.

    Examples
    --------
    >>> row = np.ones(3)
    >>> q = heat_release_rate(
    ...     np.arange(3.0), 0.2 * row, 100.0 * row, 400.0 * row, 0.04, 0.2095, 0.0
    ... )
    >>> round(float(q[0]))
    3401
    """
    x = np.interp(time_s + delay_s, time_s, oxygen)
    flow = c_factor * np.sqrt(np.maximum(pressure_Pa, 0.0) / stack_K)
    q: FloatArray = _MASS_RATIO * E_J_KG * flow * (ambient_oxygen - x) / (1.105 - 1.5 * x)
    return q
