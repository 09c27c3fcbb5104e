"""Cone calorimeter and fire propagation apparatus: a slab under radiant heat that burns."""

from typing import ClassVar, Literal

from pydantic import Field

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

    @property
    def jumps(self) -> bool:
        """Whether there is an ignition."""
        return self.flame is not None

    def burning(self) -> Flame | None:
        """Return the flame; without one, released gas burns at once."""
        return self.flame


KIND = slab_kind(
    Cone,
    designs,
    from_files("files of a cone calorimeter or FPA, in which the slab burns", facts),
)
