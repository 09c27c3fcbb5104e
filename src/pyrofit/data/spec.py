"""Where a measured series lies, and how it is read."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from pyrofit.errors import DataError, suggest
from pyrofit.quantities import known_quantities
from pyrofit.quantities.base import LIMITS, Quantity


@dataclass(frozen=True)
class SeriesSpec:
    """Where a measured series lies and how to read it.

    Parameters
    ----------
    quantity : str
        Name of a quantity, see `pyrofit.quantities`.
    path : Path
        The file.
    columns : mapping of str to str
        Header name by role (`time`, `value`, `uncertainty`, `temperature`); the others are
        recognised from well-known header names. The limits of a band, `lower` and `upper`, are
        read only where they are named.
    units : mapping of str to str
        Unit by role, in place of the one in the file.
    uncertainty : float, optional
        One uncertainty for all points, in the SI unit of the quantity; replaces the file's.
    uncertainty_meaning : str
        The meaning of the uncertainty, such as "two standard deviations of the mean".
    sample_mass_kg : float, optional
        Initial mass of the sample [kg]: divides a mass to give a mass fraction, and a power to give
        one per mass.
    sample_area_m2 : float, optional
        Exposed area of the sample [m2]: divides a mass rate or a heat rate to give a flux, and a
        mass to give a mass per area.
    sign : int
        Sign of the file's values, 1 or -1.
    from_first : bool
        Whether mass fractions are divided by the first one: the sample was dried before.
    rate_K_s : float, optional
        Constant heating rate [K/s] of a file without times: t = (T - T0)/rate.
    start_K : float, optional
        First temperature T0 [K] of a file without temperatures: T = T0 + rate t.

    Raises
    ------
    DataError
        Unknown quantity or role, or a number that is not above 0.
    """

    quantity: str
    path: Path
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    uncertainty: float | None = None
    uncertainty_meaning: str = ""
    sample_mass_kg: float | None = None
    sample_area_m2: float | None = None
    sign: int = 1
    from_first: bool = False
    rate_K_s: float | None = None
    start_K: float | None = None

    @property
    def computed(self) -> str:
        """The role that no column has, as the heating rate tells it; nothing where all have one."""
        if self.rate_K_s is None:
            return ""
        return "time" if self.start_K is None else "temperature"

    def __post_init__(self) -> None:
        if self.quantity not in (known := known_quantities()):
            raise DataError(
                f"{self.path}: unknown quantity '{self.quantity}'. {suggest(self.quantity, known)}"
            )
        for key in ("columns", "units"):
            for role in getattr(self, key):
                if role not in (roles := [*self.of.roles, *LIMITS]):
                    raise DataError(
                        f"{self.path}: `{key}` names an unknown role '{role}' for "
                        f"{self.quantity}. {suggest(role, roles)}"
                    )
        for key in ("uncertainty", "sample_mass_kg", "sample_area_m2"):
            number = getattr(self, key)
            if number is not None and not (math.isfinite(number) and number > 0.0):
                raise DataError(
                    f"{self.path}: {key} = {number}; it must be a number above 0. "
                    "Correct it or leave it out."
                )
        if len(given := [role for role in LIMITS if role in self.columns]) == 1:
            raise DataError(
                f"{self.path}: `columns` names the {given[0]} limit alone; name both, lower and "
                "upper, or neither."
            )
        if self.uncertainty is not None and "uncertainty" in self.columns:
            raise DataError(
                f"{self.path}: both a number and a column are given for the uncertainty; "
                "leave one of them out."
            )

    @property
    def of(self) -> Quantity:
        """The quantity."""
        return known_quantities()[self.quantity]
