"""Temperature at a depth in the sample, of a thermocouple that moves with it or stays."""

from dataclasses import replace

from pyrofit.quantities.base import Quantity
from pyrofit.quantities.temperature import temperature

QUANTITY: Quantity = replace(
    temperature(
        "in-depth",
        headers=("In-depth temperature", "TC"),
        pattern=r"(tc|t|temp(erature)?|thermocouple)(at|in)?(depth)?\d+(mm)?|.*in-?depth.*",
    ),
    output="inside_temperature",
    place="depth",
)
