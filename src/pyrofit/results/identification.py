"""Stored results of the analysis of identifiability."""

from typing import NamedTuple

import pandas as pd
from pydantic import Field

from pyrofit.config import Study
from pyrofit.results import goodness
from pyrofit.results.files import Results, read_csv
from pyrofit.results.goodness import Goodness
from pyrofit.results.record import Record, read_record, write_record

_SETS: dict[str, type] = {"set": object, "chi2": float}
_NUMBERS = (
    "estimate",
    "sd",
    "apparatus_sd",
    "low",
    "high",
    "width",
    "noise_low",
    "noise_high",
    "noise_width",
)


class Channel(Record):
    """The noise of a channel."""

    experiment: str = Field(description="name of the experiment")
    signal: str = Field(description="signal")
    points: int = Field(description="number of points")
    sd_median: float = Field(description="median standard deviation, SI unit")
    points_sd: float = Field(description="the same of single points")
    lasting_sd: float = Field(description="the same of lasting errors")
    lags: list[float] = Field(description="autocorrelation of points at lag 1, 2, ...")
    ar: float = Field(description="autocorrelation by lag, ar^k at lag k; 0 with `lags`")
    splines: int = Field(description="number of splines of the curve it scatters about")
    excess: float = Field(description="scatter over the stated one, 1 at least")
    whiteness: float = Field(description="p of white noise as correlated (Ljung-Box)")
    floors: dict[str, float] = Field(description="medians of added terms, SI unit")
    words: str = Field(description="the noise in words")
    chi2: float = Field(description="chi-square at the optimum")


class StageNoise(Record):
    """The noise of all channels of a stage, and chi-square at the optimum."""

    channels: list[Channel] = Field(min_length=1, description="the channels")
    chi2: float = Field(description="chi-square at the optimum, all channels")
    freedom: float = Field(description="its degrees of freedom")
    dispersion: float = Field(description="chi-square over freedom, 1 at least")


class Identified(NamedTuple):
    """All results of the analysis, read at once, those of a stage under its name."""

    estimates: dict[str, pd.DataFrame]
    correlations: dict[str, pd.DataFrame]
    noise: dict[str, StageNoise]
    goodness: dict[str, Goodness]
    sets: pd.DataFrame
    """Sets of the optimisers: distance of each parameter from the optimum [sd], chi-square."""


def read(study: Study, results: Results) -> Identified:
    """Return all results of the analysis.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    stages = stages_of(study)
    return Identified(
        estimates={stage: estimates(study, results, stage) for stage in stages},
        correlations={stage: matrix_of(study, results, stage) for stage in stages},
        noise={stage: read_noise(results, stage) for stage in stages},
        goodness={stage: goodness.read(results, stage) for stage in stages},
        sets=_sets(study, results),
    )


def stages_of(study: Study) -> dict[str, tuple[str, ...]]:
    """Return the estimated parameters of each stage, 'kinetics' and 'imp'."""
    kinetics = {} if study.kinetics is None else {"kinetics": study.kinetics.estimate}
    return {**kinetics, "imp": study.imp.estimate}


def estimates(study: Study, results: Results, stage: str = "imp") -> pd.DataFrame:
    """Return the result of the analysis for each parameter, SI units, in the study's order."""
    names = [(name,) for name in stages_of(study)[stage]]
    words = ("apparatus_most", "bound", "low_open", "high_open", "method", "verdict")
    columns = {**dict.fromkeys(_NUMBERS, float), **dict.fromkeys(words, object)}
    path = results.identification("estimate.csv", stage)
    frame = read_csv(path, columns, {("parameter",): names})
    # Read as numbers where all are empty.
    texts = {n: frame[n].astype(object).fillna("") for n in ("apparatus_most", "bound")}
    return frame.assign(**texts).set_index("parameter", drop=False)


def matrix_of(study: Study, results: Results, stage: str = "imp") -> pd.DataFrame:
    """Return the correlation matrix of the estimates, by name."""
    names = list(stages_of(study)[stage])
    path = results.identification("correlation.csv", stage)
    frame = read_csv(path, {"parameter": object, **dict.fromkeys(names, float)})
    return frame.set_index("parameter").loc[names, names]


def write_noise(results: Results, stage: str, found: StageNoise) -> None:
    """Write the noise of a stage's channels."""
    write_record(results.identification("noise.json", stage), found)


def read_noise(results: Results, stage: str = "imp") -> StageNoise:
    """Return the noise of the channels, and chi-square at the optimum."""
    return read_record(results.identification("noise.json", stage), StageNoise)


def _sets(study: Study, results: Results) -> pd.DataFrame:
    costs = [(cost,) for cost in study.imp.costs]
    columns = {**_SETS, **dict.fromkeys(study.imp.estimate, float)}
    return read_csv(results.identification("sets.csv"), columns, {("cost_function",): costs})
