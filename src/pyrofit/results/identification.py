"""What the data determine of the parameters, as the analysis left it."""

from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import EACH, Results, read_csv, read_json

WITHIN = 1.96
"""Standard deviations that a value within a 95 % interval is away at most."""

_NUMBERS = ("estimate", "sd", "low", "high", "width", "noise_low", "noise_high", "noise_width")


def stages_of(study: Study) -> dict[str, tuple[str, ...]]:
    """Return the estimated parameters of each stage, 'kinetics' and 'imp'."""
    kinetics = {} if study.kinetics is None else {"kinetics": study.kinetics.estimate}
    return {**kinetics, "imp": study.imp.estimate}


def estimates(study: Study, results: Results, stage: str = "imp") -> pd.DataFrame:
    """Return what the analysis says about each parameter, SI units, in the study's order."""
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
