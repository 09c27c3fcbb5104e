"""Results as the steps leave them: what each file must hold where it is read again."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.files import EACH, Keys, Results, read_csv, read_json
from pyrofit.solver.outputs import MASS_FRACTION

VERDICTS = ("none", "named", "ambiguous", "multiple", "unknown")
"""Kinds of verdict of the diagnosis."""

_SETS_OF_KINETICS = ("A_1_s", "E_J_mol", "order", MASS_FRACTION)


def series(study: Study, results: Results, experiment: str, signal: str) -> pd.DataFrame:
    """Return a measured series in SI units."""
    quantity = study.experiments[experiment].quantity(signal)
    columns = {"time_s": float, quantity.column: float}
    if quantity.against_temperature:
        columns["temperature_K"] = float
    return read_csv(results.measurement(experiment, signal), columns)


def measured(study: Study, results: Results) -> dict[str, Any]:
    """Return what was read, by experiment and signal."""
    needs: dict[Keys, type] = {}
    for name, experiment in study.experiments.items():
        for signal in experiment.signals:
            here = ("signals", name, signal)
            needs |= {(*here, "source"): str, (*here, "sha256"): str, (*here, "points"): float}
            if experiment.quantity(signal).released is not None:
                needs[*here, "released_kg_m2"] = float
    return read_json(results.measurements_summary, needs)


def fitted_kinetics(study: Study, results: Results) -> dict[str, float]:
    """Return the parameters fitted to TGA, SI units."""
    names = study.kinetics.estimate if study.kinetics else ()
    found = read_json(results.kinetics("fit.json"), {("parameters", n): float for n in names})
    parameters: dict[str, float] = found["parameters"]
    return parameters


def kinetic_ends(study: Study, results: Results) -> list[dict[str, float]]:
    """Return the fit to TGA and the ends of least squares beside it, SI units."""
    names = study.kinetics.estimate if study.kinetics else ()
    needs: dict[Keys, type] = {("parameters", name): float for name in names}
    needs |= {("least_squares", EACH, "parameters", name): float for name in names}
    found = read_json(results.kinetics("fit.json"), needs)
    return [found["parameters"], *(start["parameters"] for start in found["least_squares"])]


def kinetic_sets(study: Study, results: Results) -> dict[str, Any]:
    """Return the fit to TGA: ``cost``, and A, E, n and mass fraction by set and reaction."""
    needs: dict[Keys, type] = {("cost",): float}
    for label in _sets(study):
        for reaction in study.material.reactions:
            needs |= {("sets", label, reaction, key): float for key in _SETS_OF_KINETICS}
    return read_json(results.kinetics("fit.json"), needs)


def kinetic_curves(study: Study, results: Results, experiments: Sequence[str]) -> pd.DataFrame:
    """Return the curves of every set at the TGA experiments."""
    return read_csv(
        results.kinetics("curves.csv"),
        {"temperature_K": float, MASS_FRACTION: float, "experiment": object, "set": object},
        {("experiment", "set"): [(name, label) for name in experiments for label in _sets(study)]},
    )


def kinetic_scores(study: Study, results: Results, experiments: Sequence[str]) -> pd.DataFrame:
    """Return the scores of every set at the TGA experiments."""
    return read_csv(
        results.kinetics("scores.csv"),
        {"rmse_mass_fraction": float, "experiment": object, "set": object},
        {("experiment", "set"): [(name, label) for name in experiments for label in _sets(study)]},
    )


def _sets(study: Study) -> list[str]:
    return ["fitted", *(study.kinetics.sets if study.kinetics else ())]


def repetition(study: Study, results: Results, cost: str, number: int) -> dict[str, Any]:
    """Return the result of one repetition."""
    needs: dict[Keys, type] = {("digest",): str, ("cost",): float, ("cost_refined",): float}
    needs |= {("parameters", name): float for name in study.imp.estimate}
    return read_json(results.repetition(cost, number, ".json"), needs)


def running_minimum(results: Results, cost: str, number: int) -> pd.DataFrame:
    """Return how the lowest cost of one repetition fell."""
    path = results.repetition(cost, number, "_convergence.csv")
    return read_csv(path, dict.fromkeys(("generation", "calls", "best_cost"), float))


def summary(study: Study, results: Results) -> pd.DataFrame:
    """Return the best set of every repetition."""
    numbers = ("cost", "cost_refined", "calls", "failed_calls", *study.imp.estimate)
    return read_csv(
        results.imp("summary.csv"),
        {"cost_function": object, **dict.fromkeys(numbers, float)},
        {("cost_function",): [(cost,) for cost in study.imp.costs]},
    )


def running_minima(study: Study, results: Results) -> pd.DataFrame:
    """Return how the lowest cost of every repetition fell."""
    numbers = ("repetition", "generation", "calls", "best_cost")
    return read_csv(
        results.imp("convergence.csv"),
        {"cost_function": object, **dict.fromkeys(numbers, float)},
        {("cost_function",): [(cost,) for cost in study.imp.costs]},
    )


def starts(study: Study, results: Results, cost: str) -> list[dict[str, Any]]:
    """Return what least squares found from every start, best first."""
    return _ends(study, results.least_squares(cost))


def cmaes(study: Study, results: Results, cost: str) -> list[dict[str, Any]]:
    """Return what CMA-ES found from every start, best first."""
    return _ends(study, results.cmaes(cost))


def _ends(study: Study, path: Path) -> list[dict[str, Any]]:
    here = ("starts", EACH)
    needs: dict[Keys, type] = {(*here, "cost"): float, (*here, "calls"): float}
    needs[*here, "at_bound"] = list
    needs |= {(*here, "parameters", name): float for name in study.imp.estimate}
    found: list[dict[str, Any]] = read_json(path, needs)["starts"]
    return found


def end_of_descent(results: Results, cost: str) -> dict[str, Any]:
    """Return where least squares got to from SCE-UA's best set."""
    found: dict[str, Any] = read_json(results.descent(cost), {("end", "cost"): float})["end"]
    return found


def predicted_curves(study: Study, results: Results, labels: Sequence[str]) -> pd.DataFrame:
    """Return the curves of the labelled sets at the predicted experiments."""
    return read_csv(
        results.validation("curves.csv"),
        dict.fromkeys(("time_s", "simulated", "measured"), float),
        _predicted(study, labels),
    )


def predicted_scores(study: Study, results: Results, labels: Sequence[str]) -> pd.DataFrame:
    """Return the scores of the labelled sets at the predicted experiments."""
    return read_csv(
        results.validation("scores.csv"),
        {
            **dict.fromkeys(("points", "rmse_si", "solver_rmse_si"), float),
            **dict.fromkeys(("cv_rmse", "solver_cv_rmse"), object),
        },
        _predicted(study, labels),
    )


def _predicted(study: Study, labels: Sequence[str]) -> dict[Keys, list[Keys]]:
    rows: list[Keys] = [
        (name, signal, label)
        for name in study.validation.experiments
        for signal in study.experiments[name].signals
        for label in labels
    ]
    return {("experiment", "signal", "set"): rows}


def diagnosis(study: Study, results: Results) -> dict[str, Any]:
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


def diagnosed_curves(study: Study, results: Results) -> pd.DataFrame:
    """Return measured curves, those of the base and those with the named effects, SI units."""
    channels = [(c["experiment"], c["signal"]) for c in diagnosis(study, results)["noise"]]
    numbers = ("time_s", "measured", "sd", "before")
    return read_csv(
        results.diagnosis("curves.csv"),
        {**dict.fromkeys(numbers, float), **dict.fromkeys(("temperature_K", "after"), object)},
        {("experiment", "signal"): channels},
    )
