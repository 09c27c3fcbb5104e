r"""Properties of a material from times to ignition at several radiant fluxes.

All of the usual relations are straight lines of the flux q,

    t^-n = b (q - q_cr),

with the critical heat flux q_cr where the line meets zero. A thermally thick solid has n = 1/2 and
b = (4/pi)^(1/2) / TRP, with the thermal response parameter TRP = (k rho c)^(1/2) dT [W s^(1/2)/m2]
(Tewarson; Quintiere, Fundamentals of Fire Phenomena, 2006). Janssens' n = 0.547 follows from the
solution with heat losses that grow with the temperature of the surface (Janssens, Fire and
Materials 15, 1991). A thermally thin solid has n = 1 and b = 1/(rho c L dT).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from scipy.optimize import brentq
from scipy.stats import t as students_t

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.numerics import functions, linear

Law = Literal["thick", "janssens", "thin"]
EXPONENTS: dict[Law, float] = {"thick": 0.5, "janssens": 0.547, "thin": 1.0}
"""Exponent n of each relation."""
FEWEST = 3
"""Tests of a line with an interval."""
LEVEL = 0.95
_AMBIENT_K = 298.15
_HOTTEST_K = 3000.0

Interval = tuple[float, float]


@dataclass(frozen=True)
class RelationLine:
    """The line of a relation through times to ignition; None where it is not determined.

    Parameters
    ----------
    critical_W_m2, critical_within
        Critical heat flux and its 95 % interval by Fieller's theorem.
    response, response_within
        Thermal response parameter [W s^(1/2)/m2] of a thick solid, rho c L dT [J/m2] of a thin one,
        and its interval.
    scatter
        Root mean square of ln(t / t of the line).
    remarks
        Numbers that are not determined, and contradictions to the tests.
    """

    critical_W_m2: float | None = None
    critical_within: list[float] | None = None
    response: float | None = None
    response_within: list[float] | None = None
    scatter: float | None = None
    remarks: list[str] = field(default_factory=list)


def line_of(
    law: Law, flux: Sequence[float], time: Sequence[float], without: Sequence[float] = ()
) -> RelationLine:
    """Return the line of a relation through times to ignition.

    Parameters
    ----------
    law
        The relation.
    flux, time
        Radiant fluxes [W/m2] and times to ignition [s] of tests that ignited.
    without
        Fluxes of tests without ignition.

    Examples
    --------
    >>> q = [20e3, 30e3, 50e3, 70e3]
    >>> line = line_of("thick", q, [(300e3 / 1.1284 / (x - 10e3)) ** 2 for x in q])
    >>> round(line.critical_W_m2), round(line.response, -2)
    (10000, 300000.0)
    """
    q, t = np.asarray(flux, float), np.asarray(time, float)
    if q.size < FEWEST or np.unique(q).size < 2:
        few = f"{q.size} tests with ignition at {np.unique(q).size} fluxes"
        return RelationLine(remarks=[f"{few}: a line needs {FEWEST} tests at 2 fluxes or more"])
    y = functions.power(t, -EXPONENTS[law])
    mean, away = y.mean(), q - q.mean()
    spread = linear.dot(away, away)
    slope = linear.dot(away, y) / spread
    left = y - mean - slope * away
    error = linear.dot(left, left) / (q.size - 2)
    reach = float(students_t.ppf(0.5 + LEVEL / 2.0, q.size - 2)) ** 2 * error
    curved = slope**2 - reach / spread
    if slope <= 0.0 or curved <= 0.0:
        why = "the times hardly depend on the flux: nothing is determined by this line"
        return RelationLine(remarks=[why])
    critical = float(q.mean() - mean / slope)
    root = np.sqrt(max((mean * slope) ** 2 - curved * (mean**2 - reach / q.size), 0.0))
    lower, upper = (float(q.mean() + (-mean * slope + s * root) / curved) for s in (-1.0, 1.0))
    within = float(np.sqrt(reach / spread))
    factor = 1.0 if law == "thin" else float(np.sqrt(4.0 / np.pi))
    has_response = law != "janssens"
    fitted = mean + slope * away
    scatter = None
    if (fitted > 0.0).all():
        logs = functions.log(y / fitted) / EXPONENTS[law]
        scatter = float(np.sqrt(np.mean(logs**2)))
    remarks = _remarks(critical, (lower, upper), q, without)
    told = critical > 0.0
    return RelationLine(
        critical if told else None,
        [max(lower, 0.0), upper] if told else None,
        factor / slope if has_response else None,
        [factor / (slope + within), factor / (slope - within)] if has_response else None,
        scatter,
        remarks,
    )


def _remarks(
    critical: float, within: Interval, ignited: np.ndarray, without: Sequence[float]
) -> list[str]:
    """Say where a critical flux is impossible, or contradicts the tests."""
    said = []
    if critical <= 0.0:
        upper = f"its upper limit is {_kW(within[1])}" if within[1] > 0.0 else "its interval is too"
        said.append(
            f"the line meets zero at a flux below 0, which no material has; {upper}. Test at lower "
            "fluxes, and compare the other relations"
        )
    elif within[0] < 0.0:
        said.append("the interval of the critical flux reaches zero: the tests give no lower limit")
    if critical > ignited.min():
        said.append(
            f"samples ignited at {_kW(float(ignited.min()))}, below this critical flux: it does "
            "not hold there"
        )
    if len(without) and critical > 0.0 and (largest := max(without)) > critical:
        said.append(f"a sample did not ignite at {_kW(largest)}, above this critical flux")
    return said


def _kW(flux: float) -> str:
    return f"{flux / 1e3:.3g} kW/m²"


def ignition_temperature(critical_W_m2: float, emissivity: float, h_W_m2K: float) -> float:
    """Return the temperature [K] of a surface that a critical flux keeps from cooling.

        eps q_cr = h (T - T_0) + eps sigma (T^4 - T_0^4),  T_0 = 298.15 K

    Parameters
    ----------
    critical_W_m2
        Critical heat flux [W/m2].
    emissivity, h_W_m2K
        Emissivity, and heat transfer coefficient [W/(m2 K)].

    Examples
    --------
    >>> round(ignition_temperature(10e3, 0.9, 10.0), 1)
    595.7
    """

    def lost(T: float) -> float:
        fourth = functions.fourth_power
        radiated = emissivity * STEFAN_BOLTZMANN * (fourth(T) - fourth(_AMBIENT_K))
        return h_W_m2K * (T - _AMBIENT_K) + radiated - emissivity * critical_W_m2

    return float(brentq(lost, _AMBIENT_K, _HOTTEST_K))
