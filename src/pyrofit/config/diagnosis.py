"""What a study says about its diagnosis."""

from pydantic import Field

from pyrofit.model.base import Part


class Known(Part):
    """Normal prior knowledge of an estimated parameter."""

    value: float = Field(description="mean, in the parameter's unit")
    sd: float = Field(gt=0.0, description="standard deviation, in the parameter's unit")


class Diagnosis(Part):
    """Stage 4: which effect the model lacks."""

    calibrate: dict[str, tuple[str, ...]] = Field(
        default_factory=dict,
        description="signals by experiment that are fitted; none = those from which is found what "
        "the data determine, of kinetics where imp does not take a published set, and of imp",
    )
    hold_out: dict[str, tuple[str, ...]] = Field(
        default_factory=dict,
        description="signals by experiment that are predicted only; none = those of "
        "validation.experiments that are not fitted",
    )
    estimate: tuple[str, ...] = Field(
        (),
        description="parameters to estimate; none = those of kinetics where a TGA is fitted or "
        "they have no value, then those of imp",
    )
    kinetics: str = Field(
        "", description="'described', 'fitted', or one of kinetics.sets; none = as imp.kinetics"
    )
    known: dict[str, Known] = Field(
        default_factory=dict, description="what is known of estimated parameters beforehand"
    )
    effects: tuple[str, ...] | None = Field(
        None, description="candidates; none = all of the catalogue that the fitted signals can show"
    )
    most_effects: int = Field(3, ge=1, le=3, description="effects that are added at most")
