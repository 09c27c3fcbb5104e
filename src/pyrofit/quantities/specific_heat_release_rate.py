"""Heat release rate of the burning gas, per initial mass."""

from pyrofit.quantities.base import Quantity, Shown

QUANTITY = Quantity(
    kinds=("mcc",),
    title="specific heat release rate",
    symbol="Q",
    unit="W/kg",
    column="specific_heat_release_rate_W_kg",
    uncertainty_column="specific_heat_release_rate_uncertainty_W_kg",
    shown=Shown("W/g", 1e-3),
    scales=("specific power", "power"),
    headers=("HRR", "Specific HRR", "Heat release rate", "Specific heat release rate"),
    pattern=r".*hrr.*|(?!(total|cumul|integr)(?!.*rate)).*heatrelease(?!d|capacity).*|q",
    guess=lambda first, largest: "W/g",
    largest=(1e3, 5e6),
    sign_ratio=0.3,
    against_temperature=True,
    solver_error=1e-4,
    usual_sd=2e3,
    # ASSUME: repeats of one laboratory differ by about as much.
    discrepancy_share=0.02,
    drift_share=0.02,
    sensitivity_error=0.03,
    temperature_error_K=1.0,
    rests_on=("heat_of_combustion_J_kg",),
)
