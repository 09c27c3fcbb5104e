"""The faces of a slab: irradiation, flame, exchange of heat with the surroundings."""

from typing import Self

from pydantic import Field, model_validator

from pyrofit.model.base import Fraction, NotNegative, Number, Part
from pyrofit.model.time_table import CoefficientOverTime, FluxOverTime, TemperatureOverTime


class Side(Part):
    """Heat exchange of one side with its surroundings."""

    h_W_m2K: CoefficientOverTime = Field(
        0.0, description="heat transfer coefficient, may follow a table over time [W/(m2 K)]"
    )
    h_change_W_m2K: Number = Field(
        0.0,
        description="added to the heat transfer coefficient, at every time of its table; the sum "
        "is at least 0 [W/(m2 K)]",
    )
    h_cube_root_W_m2K43: NotNegative = Field(
        0.0, description="C of an additional h = C |T - T_gas|^(1/3) [W/(m2 K^(4/3))]"
    )
    gas_temperature_K: TemperatureOverTime = Field(
        293.15, description="gas temperature for convection, may follow a table over time [K]"
    )
    gas_rise_K: Number = Field(0.0, description="rise of the gas temperature from t = 0 on [K]")
    gas_rise_time_s: NotNegative = Field(
        0.0, description="time constant of that rise [s]; 0 = at once"
    )
    wall_temperature_K: TemperatureOverTime = Field(
        293.15,
        description="temperature of the radiating surroundings, may follow a table over time [K]",
    )


class FluxProfile(Part):
    """The flux over the radius of a round sample, linear between given points."""

    radius_m: tuple[float, ...] = Field(description="increasing radii [m], from 0 to the edge")
    relative_flux: tuple[float, ...] = Field(description="flux there over the one of the front [-]")

    @model_validator(mode="after")
    def _check(self) -> Self:
        given = len(self.radius_m), len(self.relative_flux)
        if given[0] != given[1] or given[0] < 2:
            raise ValueError(
                "radius_m and relative_flux need the same length, at least 2; they have "
                f"{given[0]} and {given[1]}: add or delete points"
            )
        if self.radius_m[0] != 0.0:
            raise ValueError("radius_m must start at 0, the middle; add a point there")
        if any(b <= a for a, b in zip(self.radius_m, self.radius_m[1:], strict=False)):
            raise ValueError("radius_m must increase; sort the points by radius")
        if min(self.relative_flux) < 0.0:
            raise ValueError("relative_flux must not be negative; correct it")
        return self


class Front(Side):
    """The irradiated side."""

    flux_W_m2: FluxOverTime = Field(
        description="external radiant flux, may follow a table over time [W/m2]"
    )
    flux_factor: NotNegative = Field(1.0, description="multiplies the external radiant flux [-]")
    rise_time_s: NotNegative = Field(
        0.0, description="time constant with which the heater comes up from t = 0 on [s]"
    )
    spread: Fraction = Field(
        0.0, description="the flux varies over the surface, evenly within 1 -+ spread times q [-]"
    )
    profile: FluxProfile | None = Field(
        None, description="flux over the radius of a round sample; none = the same everywhere"
    )
    drift_1_s: Number = Field(
        0.0, description="relative change of the flux per second; it stays at least 0 [1/s]"
    )
    drift_time_s: NotNegative = Field(
        0.0, description="time constant with which the drift comes to an end [s]; 0 = never"
    )


class Flame(Part):
    """The flame of a burning sample, from ignition to flame-out."""

    flux_W_m2: NotNegative = Field(
        0.0, description="constant heat flux of the flame, added to the external flux [W/m2]"
    )
    ignition_s: NotNegative = Field(0.0, description="time of ignition [s]; before, no gas burns")
    ends_s: NotNegative | None = Field(
        None, description="time of flame-out [s]; none = burns to the end"
    )

    @model_validator(mode="after")
    def _check(self) -> Self:
        begins, ends = self.ignition_s, self.ends_s
        if isinstance(begins, float) and isinstance(ends, float) and ends <= begins:
            raise ValueError(
                f"ends_s {ends:g} must be later than ignition_s {begins:g}; leave it out where the "
                "flame lasts to the end"
            )
        return self


class Back(Side):
    """The other side."""

    emissivity: Fraction = Field(0.0, description="emissivity of the back face or foil [-]")
    loss_factor: NotNegative = Field(
        1.0, description="multiplies convection and radiation of the back [-]"
    )
