"""Part of the schema of ``diagnosis.json``: the models with effects that were fitted."""

from pydantic import Field

from pyrofit.results.record import Record


class OfStrength(Record):
    """A parameter of an effect with its 95 % interval."""

    value: float = Field(description="estimate")
    low: float = Field(description="lower end of the 95 % interval")
    high: float = Field(description="upper end of the 95 % interval")
    unit: str = Field(description="unit")
    low_wide: float | None = Field(
        description="lower end over other forms and models, of a leading model; null if the same"
    )
    high_wide: float | None = Field(
        description="upper end over other forms and models, of a leading model; null if the same"
    )


class OfRidge(Record):
    """A product of powers of an effect's parameters that the data determine better than each."""

    effect: str = Field(description="effect")
    exponents: dict[str, float] = Field(description="power of each parameter")
    relative_sd: float = Field(description="relative standard deviation of the product [-]")
    alone: dict[str, float] = Field(description="the same of each parameter [-]")


class OfCandidate(Record):
    """A model with effects that was fitted."""

    effects: list[str] = Field(description="its effects")
    free: dict[str, list[str]] = Field(
        description="fitted parameters of each effect, the strength first"
    )
    chi2: float = Field(description="chi-square")
    gain: float = Field(description="fall of chi-square below that with one effect less")
    penalised: float = Field(description="penalised chi-square")
    parameters: dict[str, OfStrength] = Field(description="parameters by effect and name")
    ridges: list[OfRidge] = Field(
        description="products of parameters that the data determine better than each"
    )
    adequate: bool | None = Field(description="no lack of fit of the final model; null for others")
    disagree: float | None = Field(
        description="p of one strength for all experiments; null where not tested"
    )
    predictions: dict[str, float] = Field(
        description="gain of the log score by experiment left out, and `held out`"
    )
    explains: bool | None = Field(
        description="it fits the held-out signals once they are fitted; null where not tested"
    )
    rejected: str = Field(description="reason of its rejection; empty if it was not rejected")
