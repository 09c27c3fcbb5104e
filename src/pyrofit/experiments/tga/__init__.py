"""Thermogravimetric analysis: mass against temperature."""

from typing import Literal

from pydantic import Field

from pyrofit.experiments.heated.from_files import from_files
from pyrofit.experiments.heated.kind import heated_kind
from pyrofit.model.heated import HeatedExperiment


class Tga(HeatedExperiment):
    """Thermogravimetric analysis."""

    kind: Literal["tga"] = Field(description="mass against temperature")


KIND = heated_kind(
    "tga",
    "TGA",
    Tga,
    from_files(help="TGA files", computed=(10.0,), signal="mass_fraction"),
)
