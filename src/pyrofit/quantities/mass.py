"""Mass of the sample per exposed area, as a load cell under it shows."""

import numpy as np

from pyrofit.quantities.base import FloatArray, Quantity, Shown

ENDS = 5
"""Points at each end of a record whose median is its level there, at most."""
UNEQUAL = 1.05
"""Ratio of the largest to the smallest mass of samples described alike, from which on it counts."""


def mass_released(time: FloatArray, mass: FloatArray) -> float:
    """Return by how much a record of mass falls from its start to its end [kg/m2].

    Medians of the first and the last five points are compared, of fewer in a short record: a load
    cell is often shaken at the start. A constant that the cell shows too much drops out.

    Parameters
    ----------
    time : times [s], increasing, shape (n,).
    mass : mass per area [kg/m2], shape (n,).

    Examples
    --------
    >>> mass_released(np.arange(12.0), np.array([6.0] + [7.0] * 5 + [0.5] * 6))
    6.5
    """
    points = min(ENDS, max(len(mass) // 3, 1))
    return float(np.median(mass[:points]) - np.median(mass[-points:]))


QUANTITY = Quantity(
    kinds=("gasification",),
    title="mass per area",
    symbol="m",
    unit="kg/m2",
    column="mass_kg_m2",
    uncertainty_column="mass_uncertainty_kg_m2",
    shown=Shown("kg/m²"),
    scales=("mass per area", "mass"),
    headers=("Mass per area", "Mass", "Sample mass", "Surface density"),
    uncertainty_headers=("Mass error",),
    pattern=r"(sample|specimen)?(mass|weight)(perarea)?|m('')?|m_kg_m2",
    guess=lambda first, largest: "g" if largest > 1.5 else "kg",
    largest=(0.05, 500.0),
    sampling="cumulative",
    solver_error=1e-3,
    # ASSUME: the frame, the wires of thermocouples and the heat on the balance.
    drift_share=0.005,
    # A tenth of a gram on a square of 100 mm.
    usual_sd=1e-2,
    released=mass_released,
)
