"""Result of the diagnosis."""

from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.results.files import EACH, Keys, Results, read_csv, read_json

VERDICTS = ("none", "named", "ambiguous", "multiple", "unknown")
"""Kinds of verdict of the diagnosis."""


def read(study: Study, results: Results) -> dict[str, Any]:
    """Return what the diagnosis found.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    path = results.diagnosis("diagnosis.json")
    found = read_json(path, dict.fromkeys(_WHOLE, list) | _DIAGNOSED)
    # Only what there is can be checked: a list may be empty.
    needs: dict[Keys, type] = {
        (name, EACH, key): kind
        for name, kinds in _LISTED.items()
        if found[name]
        for kind, keys in kinds.items()
        for key in keys
    }
    found = read_json(path, needs)
    kind = found["verdict"]["kind"]
    if kind not in VERDICTS:
        raise DataError(f"{path}: unknown verdict '{kind}'; delete it and run again")
    if kind in ("named", "ambiguous", "multiple") and not found["verdict"]["sets"]:
        raise DataError(f"{path}: 'verdict.sets' is empty; delete it and run again")
    here = {(c["experiment"], c["signal"]) for c in found["noise"] + found["windows"]}
    there = {(name, s) for name, e in study.experiments.items() for s in e.signals}
    if found["study"] != study.name or not here <= there:
        raise DataError(f"{path}: this is the diagnosis of another study; delete it and run again")
    return found


_DIAGNOSED: dict[Keys, type] = {
    ("study",): str,
    ("needed",): float,
    ("ambiguity",): float,
    ("extended_study",): str,
    ("extended", "parameters"): dict,
    **{("verdict", key): str for key in ("kind", "words")},
    **{("verdict", key): list for key in ("effects", "groups", "forms", "sets", "reasons")},
    **{("base", key): float for key in ("chi2", "points", "chi2_critical", "score_critical")},
    **{("base", key): float for key in ("scan", "scan_critical", "score")},
    ("verdict", "confirmed"): object,
    ("base", "parameters"): dict,
    ("confusability", "effects"): list,
    ("confusability", "cosine"): list,
}
_WHOLE: tuple[Keys, ...] = (
    *((name,) for name in ("noise", "windows", "screen", "candidates", "gap", "probes")),
    *((name,) for name in ("not_tried", "profiles", "next_experiment")),
)
_LISTED: dict[str, dict[type, tuple[str, ...]]] = {
    "noise": {
        str: ("experiment", "signal", "role", "unit", "words"),
        float: ("points", "sd_median", "chi2_base"),
        object: ("stated", "white"),
    },
    "windows": {
        str: ("model", "experiment", "signal", "phase", "unit"),
        float: ("start_s", "end_s", "sign", "mean", "statistic", "critical"),
        # Which may be null.
        object: ("start_K", "end_K", "surface_temperature_K", "conversion", "relative"),
    },
    "screen": {str: ("effect", "group", "family"), float: ("detectability", "z")},
    "candidates": {
        list: ("effects",),
        dict: ("free", "parameters", "predictions"),
        float: ("chi2", "gain", "penalised"),
        str: ("rejected",),
    },
    "gap": {
        str: ("experiment", "signal", "role", "unit"),
        float: ("points", "rms_before", "rms_after", "chi2_before", "chi2_after", "noise_sd"),
    },
    "not_tried": {str: ("effect", "reason")},
    "profiles": {
        str: ("effect", "parameter", "unit"),
        float: ("level", "low", "high"),
        list: ("value", "rise"),
    },
    "probes": {str: ("probe", "what", "unit"), float: ("absorbed",), list: ("shape",)},
    "next_experiment": {str: ("words",), float: ("separation_sd",)},
}


def curves(study: Study, results: Results) -> pd.DataFrame:
    """Return measured curves, those of the base and those with the named effects, SI units."""
    channels = [(c["experiment"], c["signal"]) for c in read(study, results)["noise"]]
    numbers = ("time_s", "measured", "sd", "before")
    return read_csv(
        results.diagnosis("curves.csv"),
        {**dict.fromkeys(numbers, float), **dict.fromkeys(("temperature_K", "after"), object)},
        {("experiment", "signal"): channels},
    )
