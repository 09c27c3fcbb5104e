"""The posterior of the parameters: computed once, read by tables, figures and sentences."""

from typing import Literal

import pandas as pd
from pydantic import Field

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.results.record import OfStudy, Record, StepResult

FILE = "posterior.json"
SAMPLES = "samples.csv.gz"
ENSEMBLE = "ensemble.csv"
BANDS = "bands.csv"
CORRELATION = "correlation.csv"
SETS = "sets"
"""Folder with a file of values for each set of the ensemble."""
Role = Literal["fitted", "held out", "not measured"]
_BAND = ("low", "median", "high", "parameters_low", "parameters_median", "parameters_high")


class OfDraws(Record):
    """Statistics of a parameter's draws, SI units."""

    name: str = Field(description="name of the parameter")
    mean: float = Field(description="mean of the draws")
    sd: float = Field(description="their standard deviation")
    low: float = Field(description="2.5 % quantile")
    median: float = Field(description="median")
    high: float = Field(description="97.5 % quantile")
    rhat: float = Field(description="rank-normalised split R-hat of the ensembles")
    ess: float = Field(description="effective sample size")


class OfDiscrepancy(Record):
    """Model discrepancy of a signal."""

    experiment: str = Field(description="name of the experiment")
    signal: str = Field(description="signal")
    level: float = Field(description="relative error of level, standard deviation")
    time: float = Field(description="relative error of time, standard deviation")
    offset: float = Field(description="offset over the range of the curve, standard deviation")
    lasting: float = Field(description="correlation time over the half time of the curve")


class OfBand(Record):
    """A predicted signal."""

    experiment: str = Field(description="name of the experiment")
    signal: str = Field(description="signal")
    role: Role = Field(description="whether it was fitted, held out, or not measured")
    width: float = Field(description="mean width of the 95 % band over the range of its median")
    parameters_width: float = Field(description="the same of the parameters alone")
    lacking: bool = Field(description="whether a discrepancy is part of the band")
    inside: float | None = Field(
        description="share of the measured points in the band with noise; null where none is"
    )


class SampledPosterior(OfStudy):
    """The result."""

    seed: int = Field(description="seed of the draws")
    chi2: float = Field(description="chi-square of the channels at the optimum of noise alone")
    freedom: float = Field(description="its degrees of freedom")
    probability: float = Field(description="chance that noise alone exceeds that chi-square")
    converged: bool = Field(description="whether R-hat, sample size and length suffice")
    ensembles: int = Field(description="independent ensembles")
    walkers: int = Field(description="walkers of each")
    steps: int = Field(description="steps of each")
    left_out: int = Field(description="first steps that are left out")
    calls: int = Field(description="parameter sets proposed")
    accepted: float = Field(description="share of proposals taken")
    times: float = Field(description="longest autocorrelation time in steps")
    sets: int = Field(description="sets of the ensemble that was written, of equal weight")
    parameters: list[OfDraws] = Field(min_length=1, description="the parameters")
    discrepancies: list[OfDiscrepancy] = Field(min_length=1, description="discrepancies by signal")
    bands: list[OfBand] = Field(description="the predicted signals")


RESULT = StepResult(
    "posterior",
    FILE,
    SampledPosterior,
    lambda study, found: [p.name for p in found.parameters] == [*study.imp.estimate],
)
write, read = RESULT.write, RESULT.read


def read_correlation(study: Study, results: Results) -> pd.DataFrame:
    """Return the correlation of the draws, by name."""
    names = list(study.imp.estimate)
    columns = {"parameter": object, **dict.fromkeys(names, float)}
    return read_csv(results.of_step("posterior", CORRELATION), columns).set_index("parameter")


def read_predicted_bands(results: Results) -> pd.DataFrame:
    """Return the bands of all predicted signals, SI units."""
    columns = {"experiment": object, "signal": object, **dict.fromkeys(("time_s", *_BAND), float)}
    return read_csv(results.of_step("posterior", BANDS), columns)


def samples(study: Study, results: Results) -> pd.DataFrame:
    """Return draws of the parameters, SI units."""
    return read_csv(results.of_step("posterior", SAMPLES), dict.fromkeys(study.imp.estimate, float))
