"""The mass or area of a sample by which the values of a file are divided."""

from pyrofit.new_study.columns import FoundColumn
from pyrofit.quantities.units import PER_AREA, PER_MASS, PER_START

USUAL_AREA_M2 = 0.01
"""Exposed area of a slab of 100 mm by 100 mm."""
USUAL_MASS_KG = 5e-6
"""Mass of a sample in a crucible."""


def divisor_of(found: FoundColumn) -> tuple[str, float] | None:
    """Return key and value of a signal's divisor, where its unit asks for one.

    The value is that of the file, else the usual one, see `is_told`.
    """
    wanted = found.of.scales[0]
    if PER_AREA.get(found.scale) == wanted:
        return "sample_area_m2", float(f"{found.area_m2 or USUAL_AREA_M2:.6g}")
    if PER_MASS.get(found.scale) == wanted:
        return "sample_mass_kg", found.stated.mass_kg or USUAL_MASS_KG
    if PER_START.get(found.scale) == wanted and found.tared and found.stated.mass_kg:
        return "sample_mass_kg", found.stated.mass_kg
    return None


def is_told(found: FoundColumn, key: str) -> bool:
    """Tell whether the file gives the divisor of a signal."""
    if key == "sample_area_m2":
        return found.area_m2 is not None
    return found.stated.mass_kg is not None and found.stated.mass_named
