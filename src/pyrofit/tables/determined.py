"""What the data determine: intervals, verdicts, the noise they rest on, the optimisers beside."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import EACH, Results, read_csv, read_json
from pyrofit.tables.describe import title_of

DETERMINED = "determined"
WORDS = {"kinetics": "kinetics", "imp": "inverse modelling"}
"""The stages in words."""
WITHIN = 1.96
"""Standard deviations that a value within a 95 % interval is away at most."""

_NUMBERS = ("estimate", "sd", "low", "high", "width", "noise_low", "noise_high", "noise_width")
_CUT_OFF = {
    (True, True): "both",
    (True, False): "lower",
    (False, True): "upper",
    (False, False): None,
}


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
            **{(key,): float for key in ("chi2", "freedom", "inflation")},
        },
    )


def determined(study: Study, results: Results) -> pd.DataFrame:
    """List estimate, 95 % intervals and verdict of each parameter, in its own unit.

    ``low``, ``high``, ``width_percent``: with chi-square divided by its value per degree of
    freedom where that exceeds 1; ``noise_low``, ``noise_high``: as if noise were all.
    """
    rows = []
    for stage in stages_of(study):
        found = estimates(study, results, stage)
        related = matrix_of(study, results, stage)
        rows += [_determined(study, stage, row, related) for row in found.to_dict("records")]
    return pd.DataFrame(rows)


def _determined(
    study: Study, stage: str, row: Mapping[Any, Any], related: pd.DataFrame
) -> dict[str, Any]:
    name = str(row["parameter"])
    factor = study.parameters[name].factor
    truth = {} if study.synthetic is None else {"truth": study.synthetic.truth.get(name)}
    return {
        "fit": WORDS[stage],
        "parameter": name,
        "unit": study.parameters[name].unit,
        **truth,
        **{c: float(row[c]) / factor for c in ("estimate", "low", "high")},
        "width_percent": 100.0 * float(row["width"]),
        "ends": _CUT_OFF[bool(row["low_open"]), bool(row["high_open"])],
        **{f"noise_{end}": _another(row, end, factor) for end in ("low", "high")},
        "method": row["method"],
        "verdict": row["verdict"],
        "strongest_correlation": _strongest(related, name),
    }


def _another(row: Mapping[Any, Any], end: str, factor: float) -> float | None:
    """Return an end of the interval of noise alone where it is not that of the interval."""
    noise = float(row[f"noise_{end}"])
    return None if noise == float(row[end]) else noise / factor


def _strongest(related: pd.DataFrame, name: str) -> str:
    others = related[name].drop(name)
    if others.empty or not others.any():
        return ""
    partner = str(others.abs().idxmax())
    return f"{partner} {round(others[partner], 2) + 0.0:+.2f}".replace("-", "−")


def channels(study: Study, results: Results) -> pd.DataFrame:
    """List the noise of every channel in words, and how the optimum fits it."""
    found = [
        {**c, "fit": WORDS[stage]}
        for stage in stages_of(study)
        for c in noise(results, stage)["channels"]
    ]
    rows = [
        {
            "fit": c["fit"],
            "experiment": title_of(study, c["experiment"]),
            "signal": c["signal"].replace("_", " ").replace("mlr", "mass loss rate"),
            "points": c["points"],
            "noise": c["words"],
            "chi2_per_point": c["chi2"] / c["points"],
        }
        for c in found
    ]
    return pd.DataFrame(rows)


def distances(study: Study, results: Results) -> pd.DataFrame:
    """List how far the optimisers' sets are from the optimum of the likelihood.

    Distances are in standard deviations of the parameter, chi-square per degree of freedom.
    """
    names = list(study.imp.estimate)
    columns: dict[str, type] = {"set": object, "chi2": float, **dict.fromkeys(names, float)}
    frame = read_csv(
        results.identification("sets.csv"),
        columns,
        {("cost_function",): [(cost,) for cost in study.imp.costs]},
    )
    freedom = noise(results)["freedom"]
    rows = []
    for row in frame.to_dict("records"):
        away = np.abs([float(row[name]) for name in names])
        rows.append(
            {
                "cost_function": row["cost_function"],
                "set": row["set"],
                "chi2_per_freedom": float(row["chi2"]) / freedom,
                "within": int((away <= WITHIN).sum()),
                "farthest": names[int(away.argmax())],
                "distance_sd": float(away.max()),
            }
        )
    return pd.DataFrame(rows)


def flag(verdict: str) -> str:
    """Return the verdict as a flag of Table 4, empty where the data determine the parameter.

    >>> flag("determined"), flag("undetermined, at its upper bound")
    ('', 'undetermined by the data; pushed to its upper bound by the data')
    """
    words = [] if verdict == DETERMINED else verdict.split(", ")
    return "; ".join(f"{word.replace('at its', 'pushed to its')} by the data" for word in words)
