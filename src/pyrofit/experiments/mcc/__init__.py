"""Microscale combustion calorimetry: heat release of the burning gas against temperature."""

from typing import Literal

from pydantic import Field

from pyrofit.experiments.heated.from_files import from_files
from pyrofit.experiments.heated.kind import heated_kind
from pyrofit.model.base import NotNegative
from pyrofit.model.heated import HeatedExperiment


class Mcc(HeatedExperiment):
    """Microscale combustion calorimetry."""

    kind: Literal["mcc"] = Field(description="heat release against temperature")
    response_s: NotNegative = Field(
        0.0, description="time constant with which the record follows the heat release [s]"
    )

    @property
    def response(self) -> float | str:
        """Time constant [s] of the response to its heat release, or its parameter."""
        return self.response_s


KIND = heated_kind(
    "mcc",
    "MCC",
    Mcc,
    from_files(help="files of a microscale combustion calorimeter"),
)
