"""Heat flow into a heated sample, per initial mass."""

import numpy as np

from pyrofit.quantities.base import FloatArray, Quantity, Shown

PEAK_K = 60.0
"""Distance over which a peak stands out of a baseline [K]."""
LEAST = 1.0
"""Range [W/kg] below which the unit must be wrong: c dT/dt alone is 16 W/kg at 1 K/min."""


def remark(temperature: FloatArray, flow: FloatArray) -> str:
    """Say where the largest peak releases heat, or that the values are too small.

    The peak is the largest difference between a value and the mean of those 60 K below and above. A
    baseline that is curved or far from zero does not count, nor does a cooling and what follows it
    up to the temperature before.

    >>> T = np.arange(300.0, 800.0, 10.0)
    >>> remark(T, 300.0 - 2000.0 * np.exp(-(((T - 640.0) / 20.0) ** 2)))[:52]
    'its largest peak, at 640 K, releases heat; if it tak'
    """
    if np.ptp(flow) < LEAST:
        return f"it varies by {np.ptp(flow):.2g} W/kg only: is its unit right?"
    warmest = np.maximum.accumulate(temperature)
    rising, first = np.unique(warmest, return_index=True)
    inside = rising[(rising > rising[0] + PEAK_K) & (rising < rising[-1] - PEAK_K)]
    if inside.size == 0:
        return ""

    def at(T: FloatArray) -> FloatArray:
        return np.asarray(np.interp(T, rising, flow[first]))

    above = at(inside) - 0.5 * (at(inside - PEAK_K) + at(inside + PEAK_K))
    largest = int(np.argmax(np.abs(above)))
    if above[largest] >= 0.0:
        return ""
    return (
        f"its largest peak, at {inside[largest]:.0f} K, releases heat; if it takes up heat, the "
        "file has the other sign: change `endothermic`"
    )


QUANTITY = Quantity(
    kinds=("dsc",),
    title="heat flow",
    symbol="q",
    unit="W/kg",
    column="heat_flow_W_kg",
    uncertainty_column="heat_flow_uncertainty_W_kg",
    shown=Shown("W/g", 1e-3),
    scales=("specific power", "power"),
    headers=("Heat flow", "Heat flow rate", "Heat flux", "DSC"),
    pattern=r".*heatflow.*|dsc.*|heatflux",
    guess=lambda first, largest: "W/g",
    largest=(-5e5, 5e5),
    all_within=True,
    against_temperature=True,
    has_sign=True,
    remark=remark,
    # Measured against steps of half the size.
    solver_error=1e-5,
    usual_sd=50.0,
    # ASSUME: baselines and sensitivities of repeats differ by about as much.
    discrepancy_share=0.02,
    drift_share=0.02,
    sensitivity_error=0.03,
    temperature_error_K=1.0,
    rests_on=("heat_of_reaction_J_kg", "specific_heat_J_kgK"),
)
