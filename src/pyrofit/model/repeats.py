"""Repeats of a test: several records of one description, and their differences."""

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from pyrofit.model.base import AboveZero, Part

Relative = Annotated[float, Field(gt=0.0, lt=0.25)]
"""Relative standard deviation: with four of them the factor stays above zero."""
Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]


class Nuisances(Part):
    """Standard deviations of numbers that differ between repeats or are uncertain.

    Numbers without one are taken as equal, and as described.
    """

    thickness_sd: Relative | None = Field(
        None, description="slab: relative standard deviation of the thickness, hence of the mass"
    )
    flux_sd: Relative | None = Field(
        None, description="slab: relative standard deviation of the external flux"
    )
    h_sd_W_m2K: AboveZero | None = Field(
        None,
        description="slab: standard deviation of the front's heat transfer coefficient [W/(m2 K)]",
    )
    clock_sd_s: AboveZero | None = Field(
        None, description="slab: standard deviation of the start of the clock [s]"
    )
    lag_sd_s: AboveZero | None = Field(
        None, description="TGA: standard deviation of the temperature's lag [s]"
    )

    temperature_sd_K: AboveZero | None = Field(
        None,
        description="TGA: standard deviation of the sample's temperature over that recorded [K]",
    )

    @property
    def given(self) -> dict[str, float]:
        """Return the standard deviations that are given, by key."""
        found = {key: getattr(self, key) for key in Nuisances.model_fields}
        return {key: sd for key, sd in found.items() if sd is not None}


class Repeat(Nuisances):
    """One repeat: its files, and its own standard deviations."""

    signals: dict[str, str | dict[str, Any]] = Field(
        default_factory=dict,
        description="by signal its file, or keys that this repeat has instead of the test's; a "
        "signal may be missing",
    )
    title: str = Field("", description="name in figures")
    sample: dict[str, Any] = Field(
        default_factory=dict,
        description="slab: keys of the sample that this repeat has instead of the test's",
    )
    sample_mass_kg: AboveZero | None = Field(None, description="initial sample mass [kg]")
    sample_area_m2: AboveZero | None = Field(None, description="exposed area [m2]")


def _as_tests(given: Any) -> Any:
    """Return a list, or a mapping by name, of repeats under the key ``tests``."""
    if isinstance(given, list | tuple):
        return {"tests": given}
    if isinstance(given, dict) and "tests" not in given:
        own = {key: value for key, value in given.items() if key in Nuisances.model_fields}
        return {**own, "tests": {key: value for key, value in given.items() if key not in own}}
    return given


class Repeats(Nuisances):
    """Repeats of a test: a list, or a mapping by name, with standard deviations for all."""

    tests: dict[Name, Repeat] | tuple[Repeat, ...] = Field(
        description="the repeats, by name or as a list; those of a list are numbered"
    )


AnyRepeats = Annotated[Repeats, BeforeValidator(_as_tests)]
"""Repeats as they may be written."""


class RepeatOf(Part):
    """The repeated experiment and the uncertain numbers, noted when a study is read."""

    test: str = Field(description="name of the test; its own, where it repeats none")
    nuisances: dict[str, str] = Field(
        default_factory=dict,
        description="parameters that differ or are uncertain, by the key of their standard "
        "deviation",
    )
