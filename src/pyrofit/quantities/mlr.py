"""Mass loss rate per area."""

from pyrofit.quantities.base import Quantity, Shown
from pyrofit.quantities.integral import integral

QUANTITY = Quantity(
    kinds=("gasification",),
    title="mass loss rate",
    symbol="MLR",
    unit="kg/(m2 s)",
    column="mlr_kg_m2_s",
    uncertainty_column="mlr_uncertainty_kg_m2_s",
    shown=Shown("g/(m² s)", 1e3),
    scales=("mass flux", "mass rate"),
    headers=("MLR_mean", "MLR", "MLRPUA", "Mass loss rate", "Mass flux", "Burning rate"),
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
    released=integral,
)
