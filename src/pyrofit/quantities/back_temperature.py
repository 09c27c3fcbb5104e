"""Temperature of the back face, or of the foil on it."""

from dataclasses import replace

from pyrofit.quantities.base import Quantity
from pyrofit.quantities.temperature import temperature

QUANTITY: Quantity = replace(
    temperature(
        "back",
        headers=(
            "Temp_avg_all4",
            "Temperature",
            "Temp",
            "Back temperature",
            "Back surface temperature",
            "Back temp",
            "TC back",
            "TC back 1",
        ),
        uncertainty_headers=("Temperature_Error", "Temp error"),
        pattern=r".*(back|rear|bottom).*|t_?bot|temp.*|tb|tc\d*",
    ),
    before_backing="interface_temperature",
)
