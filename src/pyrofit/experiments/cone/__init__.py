"""Cone calorimeter and fire propagation apparatus: a slab under radiant heat that burns."""

from typing import ClassVar, Literal, Self

from pydantic import Field, model_validator

from pyrofit.experiments.cone.designs import designs
from pyrofit.experiments.cone.facts import facts
from pyrofit.experiments.slab.from_files import from_files
from pyrofit.experiments.slab.kind import slab_kind
from pyrofit.model.slab import SlabExperiment
from pyrofit.model.slab_faces import Flame


class Cone(SlabExperiment):
    """Heat release and mass loss of a slab under radiant heat in air."""

    APPARATUS: ClassVar[str] = "cone calorimeter"
    LIKE: ClassVar[str] = "gasification"
    kind: Literal["cone"] = Field(description="a slab that burns under radiant heat")
    flame: Flame | None = Field(
        None, description="the flame; none = all gas burns at once and heats nothing"
    )

    @model_validator(mode="after")
    def _flame_with_oxygen(self) -> Self:
        if self.oxygen != 0.0 and self.flame is None:
            raise ValueError(
                "oxygen reaches the front before ignition and after flame-out, and the test has no "
                "flame. Give `flame` with ignition_s, and ends_s if it goes out; a slab that does "
                "not burn is of `kind: gasification`"
            )
        return self

    def burning(self) -> Flame | None:
        """Return the flame; without one, released gas burns at once."""
        return self.flame


KIND = slab_kind(
    Cone,
    designs,
    from_files("files of a cone calorimeter or FPA, in which the slab burns", facts),
)
