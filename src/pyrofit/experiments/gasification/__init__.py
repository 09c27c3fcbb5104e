"""Gasification: mass loss of a slab under radiant heat in an inert atmosphere."""

from typing import ClassVar, Literal

from pydantic import Field

from pyrofit.experiments.slab.designs import designs
from pyrofit.experiments.slab.from_files import from_files
from pyrofit.experiments.slab.kind import slab_kind
from pyrofit.model.slab import SlabExperiment


class Gasification(SlabExperiment):
    """Mass loss of a slab under radiant heat in an inert atmosphere."""

    APPARATUS: ClassVar[str] = "gasification"
    kind: Literal["gasification"] = Field(description="a slab under radiant heat")


KIND = slab_kind(
    Gasification,
    designs,
    from_files(
        help="files of a slab under radiant heat in an inert gas; without any file the "
        "measurements are computed",
        computed=(25.0, 50.0),
        signal="mlr",
    ),
)
