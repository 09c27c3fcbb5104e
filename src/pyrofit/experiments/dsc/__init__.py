"""Differential scanning calorimetry: heat flow against temperature, alone or with mass (STA)."""

from typing import Literal

from pydantic import Field

from pyrofit.experiments.heated.from_files import from_files
from pyrofit.experiments.heated.kind import heated_kind
from pyrofit.model.heated import Baseline, HeatedExperiment


class Dsc(HeatedExperiment):
    """Differential scanning calorimetry, or simultaneous thermal analysis."""

    kind: Literal["dsc"] = Field(description="heat flow, and mass, against temperature")
    baseline: Baseline = Field(
        default_factory=Baseline,
        description="additions to the heat flow of the sample, such as a baseline",
    )

    @property
    def _other_way_out(self) -> str:
        return ", and a heat flow has the baseline of its experiment"

    @property
    def line(self) -> Baseline:
        """Baseline of its heat flow."""
        return self.baseline


KIND = heated_kind(
    "dsc",
    "DSC",
    Dsc,
    from_files(help="files of a DSC, or of an STA with mass"),
)
