"""Stored results of the analysis of identifiability."""

from typing import Any, NamedTuple

import pandas as pd

from pyrofit.config import Study
from pyrofit.results import goodness
from pyrofit.results.files import Results, read_csv, read_json
from pyrofit.results.goodness import Goodness
from pyrofit.results.needed import EACH

_SETS: dict[str, type] = {"set": object, "chi2": float}
_NUMBERS = ("estimate", "sd", "low", "high", "width", "noise_low", "noise_high", "noise_width")


class Identified(NamedTuple):
    """All results of the analysis, read at once, those of a stage under its name."""

    estimates: dict[str, pd.DataFrame]
    correlations: dict[str, pd.DataFrame]
    noise: dict[str, dict[str, Any]]
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
        noise={stage: noise(results, stage) for stage in stages},
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
    words = ("bound", "low_open", "high_open", "method", "verdict")
    columns = {**dict.fromkeys(_NUMBERS, float), **dict.fromkeys(words, object)}
    path = results.identification("estimate.csv", stage)
    frame = read_csv(path, columns, {("parameter",): names})
    bound = frame["bound"].astype(object).fillna("")  # read as numbers where all are empty
    return frame.assign(bound=bound).set_index("parameter", drop=False)


def matrix_of(study: Study, results: Results, stage: str = "imp") -> pd.DataFrame:
    """Return the correlation matrix of the estimates, by name."""
    names = list(stages_of(study)[stage])
    path = results.identification("correlation.csv", stage)
    frame = read_csv(path, {"parameter": object, **dict.fromkeys(names, float)})
    return frame.set_index("parameter").loc[names, names]


def noise(results: Results, stage: str = "imp") -> dict[str, Any]:
    """Return the noise of the channels, and chi-square at the optimum."""
    here = ("channels", EACH)
    numbers = dict.fromkeys(("points", "sd_median", "chi2", "whiteness"), float)
    return read_json(
        results.identification("noise.json", stage),
        {
            **{(*here, key): str for key in ("experiment", "signal", "words")},
            **{(*here, key): kind for key, kind in numbers.items()},
            **{(key,): float for key in ("chi2", "freedom", "dispersion")},
        },
    )


def _sets(study: Study, results: Results) -> pd.DataFrame:
    costs = [(cost,) for cost in study.imp.costs]
    columns = {**_SETS, **dict.fromkeys(study.imp.estimate, float)}
    return read_csv(results.identification("sets.csv"), columns, {("cost_function",): costs})
