"""Mass loss rate per area."""

import numpy as np

from pyrofit.numerics import linear
from pyrofit.quantities.base import FloatArray, Quantity, Shown


def released(time: FloatArray, rate: FloatArray) -> float:
    """Return the integral of a mass loss rate over time [kg/m2].

    Each value is taken as the mean over a bin around its time,

        M = sum_i mlr_i (e_(i+1) - e_i),
        e_0 = 0,  e_i = (t_(i-1) + t_i) / 2,  e_n = t_(n-1)  for times t_0 ... t_(n-1).

    The first bin reaches back to t = 0, where the exposure starts, and nothing is added after the
    last time: M equals the trapezoidal rule plus `mlr_0 t_0`. Negative values count as they are.

    Parameters
    ----------
    time : times [s], increasing, shape (n,).
    rate : mass loss rate [kg/(m2 s)], shape (n,).

    Examples
    --------
    >>> released(np.array([5.0, 15.0, 25.0]), np.array([0.1, 0.2, 0.1]))  # 1 + 2 + 0.5
    3.5
    """
    edges = np.concatenate(([0.0], 0.5 * (time[:-1] + time[1:]), time[-1:]))
    return linear.dot(rate, np.diff(edges))


QUANTITY = Quantity(
    kinds=("gasification",),
    title="mass loss rate",
    symbol="MLR",
    unit="kg/(m2 s)",
    column="mlr_kg_m2_s",
    uncertainty_column="mlr_uncertainty_kg_m2_s",
    shown=Shown("g/(m² s)", 1e3),
    scales=("mass flux", "mass rate"),
    headers=("MLR_mean", "MLR", "MLRPUA", "Mass loss rate", "Mass flux"),
    uncertainty_headers=("MLR_error", "MLR uncertainty"),
    pattern=r"s?mlr.*|.*masslossrate.*|massenverlustrate|abbrandrate|massflux.*|mdot.*|dm/?dt.*",
    guess=lambda first, largest: "g/m2/s" if largest > 0.3 else "kg/m2/s",
    largest=(0.0, 2.0),
    sign_ratio=3.0,
    sampling="bin mean",
    # The error is 0.02 to 0.2 % of the mean.
    solver_error=1e-3,
    # ASSUME: the smoothing of the mass leaves errors that last.
    drift_share=0.02,
    usual_sd=5e-4,
    relative=True,
    released=released,
)
