"""How values are shown: absolute temperatures in °C, differences of temperatures in K."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import ICE_POINT_K


def shown(quantity: Quantity, values: Any) -> Any:
    """Convert absolute values from SI units to the unit shown.

    >>> from pyrofit.quantities import known_quantities
    >>> float(shown(known_quantities()["back_temperature"], 373.15))
    100.0
    """
    return quantity.shown.factor * np.asarray(values, dtype=float) + quantity.shown.offset


def difference(quantity: Quantity, values: Any) -> Any:
    """Convert differences of values from SI units to the unit of `difference_unit`."""
    return quantity.shown.factor * np.asarray(values, dtype=float)


def difference_unit(quantity: Quantity) -> str:
    """Return the unit of differences, which of temperatures is K."""
    return "K" if quantity.is_temperature else quantity.shown.unit


def celsius(kelvin: Any) -> Any:
    """Convert K to °C."""
    return np.asarray(kelvin, dtype=float) - ICE_POINT_K


def unit_cells(
    measure: str, quantity: Quantity, value: float | None, among: Iterable[Quantity]
) -> dict[str, float | None]:
    """Return the cells of a measure that has the unit of its quantity, a column for each unit.

    Parameters
    ----------
    measure
        Beginning of the columns' names.
    quantity, value
        Quantity, and the measure of it in SI units; none for a relative quantity.
    among
        The quantities of all rows of the table: there is a column for each unit of theirs.
    """
    units = dict.fromkeys(["K", *(difference_unit(q) for q in among if not q.relative)])
    mine = None if quantity.relative else difference_unit(quantity)
    names = {unit: f"{measure}_K" if unit == "K" else f"{measure} [{unit}]" for unit in units}
    shown_value = None if value is None else float(difference(quantity, value))
    return {name: shown_value if unit == mine else None for unit, name in names.items()}
