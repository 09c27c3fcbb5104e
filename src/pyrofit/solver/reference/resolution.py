"""How finely the reference solver works."""

from pydantic import Field

from pyrofit.model.base import Part


class Resolution(Part):
    """How finely the reference solver solves the slab and TGA equations.

    By default the mass loss rate is off (rms over mean) by 0.001 % in the paper's case at 25 kW/m2,
    by 0.02 % at 60 and by 0.4 % for a material of k = 0.06 W/(m K) at 100; the error falls with the
    square of the element size.
    """

    elements: int = Field(400, ge=2, le=5000, description="finite elements of the slab")
    tolerance: float = Field(
        1e-6,
        gt=0.0,
        le=1e-2,
        description="error of a step, relative to T and to the mass of an element",
    )
    most_steps: int = Field(200000, ge=100, description="steps after which a run is given up")
    tga_tolerance: float = Field(
        1e-10, gt=0.0, le=1e-3, description="error of a TGA step, relative to the sample's mass"
    )
