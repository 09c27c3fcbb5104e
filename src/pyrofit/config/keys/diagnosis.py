"""Keys of the diagnosis of a study."""

from typing import Any

from pydantic import Field, model_validator

from pyrofit.model.base import Part


class Diagnosis(Part):
    """Stage 4: which effect the model lacks."""

    calibrate: dict[str, tuple[str, ...]] = Field(
        default_factory=dict,
        description="fitted signals by experiment; none = the signals of the identification, with "
        "those of kinetics where imp takes no published set",
    )
    hold_out: dict[str, tuple[str, ...]] = Field(
        default_factory=dict,
        description="signals by experiment that are predicted only; none = those of "
        "validation.experiments that are not fitted",
    )
    estimate: tuple[str, ...] = Field(
        (),
        description="parameters to estimate; none = those of imp and `known`, and those of "
        "kinetics if a TGA is fitted or they lack values",
    )
    kinetics: str = Field(
        "", description="'described', 'fitted', or one of kinetics.sets; none = as imp.kinetics"
    )
    effects: tuple[str, ...] | None = Field(
        None, description="candidates; none = all of the catalogue that the fitted signals can show"
    )
    plausible: dict[str, tuple[float, float]] = Field(
        default_factory=dict,
        description="plausible range of the strength of an effect of apparatus or surroundings, SI "
        "unit, two standard deviations to either side. None = that of the catalogue",
    )
    most_effects: int = Field(3, ge=1, le=6, description="effects that are added at most")

    @model_validator(mode="before")
    @classmethod
    def _known_of_the_study(cls, given: Any) -> Any:
        if isinstance(given, dict) and "known" in given:
            raise ValueError(
                "known values hold for the whole study: move `known` to the top level of the study"
            )
        return given
