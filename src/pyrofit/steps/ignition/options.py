"""Options of the times to ignition."""

from pydantic import Field

from pyrofit.model.base import Part


class IgnitionOptions(Part):
    """Times to ignition and critical heat flux, `snakemake ignition`."""

    heat_release_W_m2: float = Field(
        25e3, gt=0.0, description="heat release rate of a sample that burns [W/m2]"
    )
    mlr_kg_m2_s: float = Field(
        1e-3, gt=0.0, description="mass loss rate of a sample that ignites [kg/(m2 s)]"
    )
    sustained_s: float = Field(
        10.0, ge=0.0, description="how long a rate must stay above, 10 s in ISO 5660-1 [s]"
    )
    convection_W_m2K: float = Field(
        10.0, ge=0.0, description="heat transfer coefficient of the temperature of ignition"
    )
    emissivity: float = Field(
        0.9, gt=0.0, le=1.0, description="emissivity of the temperature of ignition"
    )


OPTIONS = IgnitionOptions
