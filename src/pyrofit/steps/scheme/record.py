"""Result of the choice of a reaction scheme: computed once, read by tables, figure and report."""

from typing import Any

import pandas as pd
from pydantic import Field

from pyrofit.results.files import Results, read_csv
from pyrofit.results.record import OfStudy, Record, StepResult

FILE = "scheme.json"
CURVES = "curves.csv"
EXTENDED = "extended.yaml"
COLUMNS = ("temperature_K", "measured", "before", "after", "predicted")


class OfRecord(Record):
    """A record of mass, and how a scheme meets it."""

    experiment: str = Field(description="experiment")
    heating_rate_K_min: float = Field(description="nominal heating rate [K/min]")
    laboratory: str = Field(description="who recorded it, if the study says so")
    calibrated: bool = Field(description="schemes are fitted to it")
    rms: float = Field(description="of the fit; of a record that is not fitted, of its prediction")
    predicted_rms: float | None = Field(
        description="rms of the prediction by a fit without its heating rate; null if none was made"
    )


class OfScheme(Record):
    """A scheme as it was fitted."""

    name: str = Field(description="identifier")
    words: str = Field(description="the scheme in words")
    parameters: int = Field(description="parameters, nuisance offsets not counted")
    bic: float = Field(description="BIC of the fit")
    discrepancy: float = Field(
        description="misfit beyond the noise, as a fraction of the initial mass"
    )
    rms: float = Field(description="rms of mass fraction at the fitted records")
    predicted_rms: float | None = Field(description="rms at heating rates left out of the fit")
    held_out_rms: float | None = Field(description="rms at records that no scheme is fitted to")
    log_score: float | None = Field(
        description="log density of all heating rates, each given the others; null if not computed"
    )
    margin: float | None = Field(description="log score that it may lose to the best scheme")
    records: list[OfRecord] = Field(description="how it meets each record")


class OfSchemeParameter(Record):
    """A parameter of the chosen scheme with its 95 % interval, in its unit."""

    label: str = Field(description="name in words")
    unit: str = Field(description="unit")
    value: float = Field(description="estimate")
    low: float = Field(description="lower end of the 95 % interval")
    high: float = Field(description="upper end of the 95 % interval")
    at_limit: bool = Field(description="the estimate is at a limit")


class SchemeChoice(OfStudy):
    """The result."""

    chosen: str = Field(description="identifier of the chosen scheme")
    best: str = Field(description="identifier of the scheme that predicts best")
    largest: bool = Field(description="the chosen scheme has as many reactions as were tried")
    rule: str = Field(description="the rule of the choice")
    words: str = Field(description="the result in sentences")
    schemes: list[OfScheme] = Field(min_length=1, description="all fitted schemes, least BIC first")
    own: OfScheme = Field(description="the scheme that the study describes, fitted alike")
    parameters: dict[str, OfSchemeParameter] = Field(description="parameters of the chosen scheme")
    settings: dict[str, Any] = Field(description="numbers that steer the choice")
    extended_study: str = Field(description="file of the study with the chosen scheme")


RESULT = StepResult(
    "scheme",
    FILE,
    SchemeChoice,
    lambda study, found: {found.chosen, found.best} <= {s.name for s in found.schemes},
)
write, read = RESULT.write, RESULT.read


def read_scheme_curves(results: Results) -> pd.DataFrame:
    """Return measured and simulated masses over initial mass, by experiment."""
    needs = {"experiment": object, **dict.fromkeys(COLUMNS, float)}
    return read_csv(results.of_step("scheme", CURVES), needs)
