"""Temperature of the irradiated face."""

from pyrofit.quantities.base import Quantity
from pyrofit.quantities.temperature import temperature

QUANTITY: Quantity = temperature(
    "front",
    headers=("Front temperature", "Front surface temperature", "Surface temperature", "TC top"),
    pattern=r"(?!.*back).*(front|surface|top).*",
)
