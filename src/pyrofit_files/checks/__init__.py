"""Checks of measured files: of each alone, and between those of one test."""

from collections.abc import Callable, Sequence

from pyrofit_files.checks import copies, groups, heat, mass, padding, temperature, time
from pyrofit_files.examined import Examined

ALONE: tuple[Callable[[Examined], None], ...] = (
    time.check_times,
    time.check_start,
    temperature.check_heating_rate,
    temperature.check_range,
    temperature.check_place,
    mass.check_mass_unit,
    mass.check_course,
    mass.check_readme,
    mass.check_density,
    heat.check_heat_unit,
    heat.check_level,
    padding.check_placeholders,
    padding.check_padding,
)
"""Checks of one file."""
BETWEEN: tuple[Callable[[Sequence[Examined]], None], ...] = (
    copies.check_copies,
    groups.check_heat_per_mass,
    groups.check_scale,
    groups.check_sign,
    groups.check_half_loss,
    groups.check_initial_mass,
)
"""Checks between files."""


def run_checks(files: Sequence[Examined]) -> None:
    """Add the findings to each file."""
    readable = [seen for seen in files if seen.classified]
    for seen in readable:
        for check in ALONE:
            check(seen)
    for between in BETWEEN:
        between(readable)
