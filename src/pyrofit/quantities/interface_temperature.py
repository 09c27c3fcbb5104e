"""Temperature where two layers meet, or at the back of the last layer."""

from dataclasses import replace

from pyrofit.quantities.base import Quantity
from pyrofit.quantities.temperature import temperature

QUANTITY: Quantity = replace(
    temperature("interface", headers=("Interface temperature",), pattern=r".*interface.*"),
    output="inside_temperature",
    place="interface",
)
