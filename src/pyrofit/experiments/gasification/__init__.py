"""Gasification: mass loss of a slab under radiant heat in an inert atmosphere."""

from typing import ClassVar, Literal

from pydantic import Field

from pyrofit.experiments.base import Kind
from pyrofit.experiments.slab.course import course
from pyrofit.experiments.slab.designs import designs
from pyrofit.experiments.slab.from_files import from_files
from pyrofit.experiments.slab.simulate import reference, request, simulate, synthetic
from pyrofit.model.slab import SlabExperiment


class Gasification(SlabExperiment):
    """Mass loss of a slab under radiant heat in an inert atmosphere."""

    APPARATUS: ClassVar[str] = "gasification"
    kind: Literal["gasification"] = Field(description="a slab under radiant heat")


KIND = Kind(
    description=Gasification,
    words=Gasification.APPARATUS,
    stage="imp",
    simulate=simulate,
    reference=reference,
    request=request,
    synthetic=synthetic,
    course=course,
    designs=designs,
    files=from_files(
        help="files of a slab under radiant heat in an inert gas; without any file the "
        "measurements are computed",
        computed=(25.0, 50.0),
        signal="mlr",
    ),
)
