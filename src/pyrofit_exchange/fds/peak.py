"""A and E that FDS makes of the peak of a reaction in a TGA."""

import math
from typing import NamedTuple

from pyrofit.quantities.units import ICE_POINT_K
from pyrofit_exchange.fds.materials import R_FDS
from pyrofit_exchange.fds.versions import FdsError

HEATING_RATE_K_MIN, PYROLYSIS_RANGE_K = 5.0, 80.0
"""FDS's defaults, where a MATL line is silent."""


class Peak(NamedTuple):
    """The peak of the mass loss rate of a reaction at a constant heating rate.

    Parameters
    ----------
    temperature_C
        Temperature of the peak, REFERENCE_TEMPERATURE [C].
    rate_1_s
        Mass loss rate at the peak over the initial mass, REFERENCE_RATE [1/s]; None if not given.
    range_K
        Width of a triangle that replaces the peak, PYROLYSIS_RANGE [K].
    heating_K_min
        HEATING_RATE [K/min].
    residue
        Solid yield [kg/kg].
    """

    temperature_C: float
    rate_1_s: float | None = None
    range_K: float = PYROLYSIS_RANGE_K
    heating_K_min: float = HEATING_RATE_K_MIN
    residue: float = 0.0


def fds_kinetics(peak: Peak, counts_gas: bool) -> tuple[float, float]:
    """Return A [1/s] and E [J/mol] of FDS, with its gas constant.

    E = e r R T_p^2 / beta and A = e r exp(E/(R T_p)). Without a given rate r it is 2 beta / dT, and
    in 6.7 that times 1 - nu, nu the solid yield.

    Raises
    ------
    FdsError
        A number is not above 0, or A is beyond the largest number.

    Examples
    --------
    >>> A, E = fds_kinetics(Peak(350.0), counts_gas=False)
    >>> print(f"{A:.4g} 1/s, {E:.0f} J/mol")
    1.394e+16 1/s, 219409 J/mol
    """
    T, beta = peak.temperature_C + ICE_POINT_K, peak.heating_K_min / 60.0
    if min(T, beta, peak.range_K) <= 0.0:
        raise FdsError("temperature [K], heating rate and range must be above 0")
    rate = peak.rate_1_s
    if rate is None or rate <= 0.0:
        rate = 2.0 * beta / peak.range_K * (1.0 - peak.residue if counts_gas else 1.0)
    E = math.e * rate * R_FDS * T**2 / beta
    try:
        return math.e * rate * math.exp(E / (R_FDS * T)), E
    except OverflowError:
        raise FdsError("the peak is too narrow: A is beyond the largest number") from None
