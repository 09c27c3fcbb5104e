"""Thermogravimetric analysis: mass against temperature."""

from typing import Literal

from pydantic import Field

from pyrofit.experiments.base import Kind
from pyrofit.experiments.heated.course import course
from pyrofit.experiments.heated.designs import designs
from pyrofit.experiments.heated.from_files import from_files
from pyrofit.experiments.heated.simulate import reference, request, simulate, synthetic
from pyrofit.model.heated import HeatedExperiment


class Tga(HeatedExperiment):
    """Thermogravimetric analysis."""

    kind: Literal["tga"] = Field(description="mass against temperature")


KIND = Kind(
    description=Tga,
    words="TGA",
    stage="kinetics",
    simulate=simulate,
    reference=reference,
    request=request,
    synthetic=synthetic,
    course=course,
    designs=lambda own, measured, recorded: designs("tga", "TGA", own, recorded),
    files=from_files(help="TGA files", computed=(10.0,), signal="mass_fraction"),
)
