"""Heat release rate per area of a burning sample."""

from pyrofit.quantities.base import Quantity, Shown
from pyrofit.quantities.integral import integral

QUANTITY = Quantity(
    kinds=("cone",),
    title="heat release rate",
    symbol="HRR",
    unit="W/m2",
    column="heat_release_rate_W_m2",
    uncertainty_column="heat_release_rate_uncertainty_W_m2",
    shown=Shown("kW/m²", 1e-3),
    scales=("heat flux", "heat rate"),
    headers=("HRR", "HRRPUA", "Heat release rate", "Heat release"),
    uncertainty_headers=("HRR_error", "HRR uncertainty"),
    pattern=r"hrr.*|(?!(total|cumul|integr)(?!.*rate)).*heatrelease(?!d).*|rhr.*|q?hrrpua.*|qdot",
    guess=lambda first, largest: "W/m2" if largest > 1e4 else "kW/m2",
    largest=(0.0, 1e7),
    sign_ratio=3.0,
    sampling="bin mean",
    # As of the mass loss rate, to which it is proportional where one reaction releases gas.
    solver_error=1e-3,
    # ISO 5660-1 calibrates the oxygen consumption to 5 %.
    sensitivity_error=0.05,
    # ASSUME: the gas analysis drifts, and its delay is corrected approximately.
    drift_share=0.02,
    usual_sd=1e4,
    relative=True,
    heat=integral,
    rests_on=("heat_of_combustion_J_kg",),
)
