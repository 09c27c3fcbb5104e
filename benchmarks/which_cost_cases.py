"""The cases of `which_cost.py`: twins of known truth, and measured data."""

import copy
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study, as_study, read_mapping
from pyrofit.data.noise import draw_noise
from pyrofit.model.signal import Noise
from pyrofit.results.files import Results
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.results.recorded import load
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.fit import fit_kinetics
from pyrofit.stages.identify import identify_kinetics
from pyrofit.stages.measurements import computed, prepare
from pyrofit_blind_test.plan import strength_at
from pyrofit_blind_test.setting import Setting, read_setting

CONFIG = Path(__file__).parents[1] / "config"
ESTIMATED = ("rho_a", "k_a", "cp_a", "eps_a", "k_r", "dh")
SIGNALS = ("mlr", "back_temperature")
SEED = 2030
ELEMENTS = 200
"""Finite elements of the truth."""
SPIKES = {"share": 0.05, "size": 10.0}
"""Outliers: share of the points that are moved, and by how many standard deviations."""
NOISES: dict[str, str] = {
    "white": "white",
    "measured": "measured",
    "lasting": "ar0.5",
    "outliers": "measured",
}
"""Kinds of noise, and the correlation in config/blind_test.yaml that each has."""
HIDDEN = (
    "k_T",
    "back_loss",
    "c_T",
    "in_depth",
    "in_depth_lost",
    "front_convection",
    "foil_mass",
    "emissivity_conversion",
    "heater_ramp",
    "time_offset",
    "volatile",
    "flux_spread",
    "balance_drift",
    "edge_loss",
)
"""Effects of config/blind_test.yaml with a nominal strength, each hidden alone."""
FAST: dict[str, float] = {
    "cells": 32,
    "tolerance": 5e-3,
    "first_step_s": 0.15,
    "longest_step_s": 20.0,
}
"""The solver's setting for searches at 25 kW/m2."""


@dataclass(frozen=True)
class Case:
    """A data set that all costs are fitted to.

    Parameters
    ----------
    kind
        'right' model, 'known' (right, and k_r is known), 'wrong' model, or 'measured' data.
    name
        Kind of noise, hidden effect, or study.
    number
        Number of the truth of a twin, or the flux [kW/m2] that is fitted.
    repetitions
        Repetitions of SCE-UA.
    """

    kind: str
    name: str
    number: int
    repetitions: int = 0

    @property
    def id(self) -> str:
        """Name of its files."""
        return f"{self.kind}_{self.name}_{self.number}"


@dataclass(frozen=True)
class Posed:
    """The data that a case gives to fit and to predict.

    Parameters
    ----------
    study
        Its study, whose one cost function compares the fitted rate.
    series
        Measurements by (experiment, signal).
    fixed
        Values of the parameters that are not estimated, SI units.
    fitted, unseen
        Experiments that are fitted and predicted.
    compared
        By (experiment, signal), the curves that predictions are compared with.
    truth
        The true values in SI units; none of measured data.
    """

    study: Study
    series: Mapping[tuple[str, str], pd.DataFrame]
    fixed: Mapping[str, float]
    fitted: str
    unseen: str
    compared: Mapping[tuple[str, str], pd.DataFrame]
    truth: FloatArray | None = None


def posed(case: Case, folder: Path) -> Posed:
    """Return the data of a case; studies of measured data keep their kinetics in the folder."""
    if case.kind == "measured":
        return _measured(case, folder)
    effect = case.name if case.kind == "wrong" else ""
    noise = "measured" if case.kind == "wrong" else case.name
    estimated = ESTIMATED if case.kind != "known" else tuple(n for n in ESTIMATED if n != "k_r")
    study, clean = _truth(effect, case.number, estimated)
    setting = _setting()
    series = dict(clean)
    for signal in SIGNALS:
        frame = clean["capa_25", signal]
        spec = Noise(sd=_sizes()[signal], **setting.noise[NOISES[noise]].get(signal, {}))
        rng = np.random.default_rng(seed_for(SEED, NOISES[noise], case.number, signal))
        quantity = study.experiments["capa_25"].quantity(signal)
        values = frame[quantity.column].to_numpy(float)
        error = draw_noise(spec.correlation(values.size), rng)
        if noise == "outliers":
            error += _spikes(values.size, rng)
        columns = {quantity.column: values + spec.sd * error}
        columns[quantity.uncertainty_column] = np.full(values.size, spec.sd)
        series["capa_25", signal] = frame.assign(**columns)
    truth = np.array([study.true_values()[name] for name in estimated])
    return Posed(study, series, study.fixed_values(), "capa_25", "capa_60", clean, truth)


def _spikes(points: int, rng: np.random.Generator) -> FloatArray:
    """Return outliers of either sign, in standard deviations of the noise, shape (points,)."""
    at = rng.choice(points, round(SPIKES["share"] * points), replace=False)
    found = np.zeros(points)
    found[at] = SPIKES["size"] * rng.choice([-1.0, 1.0], at.size)
    return found


@lru_cache
def _setting() -> Setting:
    return read_setting(CONFIG / "blind_test.yaml")


@lru_cache
def _sizes() -> dict[str, float]:
    """Return the standard deviations of the noise at 25 kW/m2."""
    given = read_mapping(CONFIG / "twin.yaml")["experiments"]["capa_25"]["signals"]
    return {signal: given[signal]["noise"]["sd"] for signal in SIGNALS}


@lru_cache(maxsize=2)
def _truth(
    effect: str, number: int, estimated: tuple[str, ...]
) -> tuple[Study, dict[tuple[str, str], pd.DataFrame]]:
    """Return the study of a truth, and its curves without noise from the reference solver."""
    given: dict[str, Any] = copy.deepcopy(dict(read_mapping(CONFIG / "twin.yaml")))
    setting, truth = _setting(), given["synthetic"]["truth"]
    rng = np.random.default_rng(seed_for(SEED, "truth", number))
    for name, at in truth.items():
        truth[name] = at + float(rng.uniform(-1, 1)) * setting.vary.get(name, 0.0)
        if name not in estimated:
            given["parameters"][name]["value"] = truth[name]
            for key in ("lower", "upper"):
                del given["parameters"][name][key]
    given["synthetic"] = {
        "truth": truth,
        "accuracy": {"elements": ELEMENTS, "tolerance": 1e-6},
        "effects": {effect: strength_at(setting, effect)} if effect else {},
    }
    given["kinetics"] = None
    given["experiments"] = {
        name: _noiseless(given["experiments"][name]) for name in ("capa_25", "capa_60")
    }
    given["imp"] = _imp(list(estimated), "capa_25")
    given["validation"] = {"experiments": ["capa_25"]}
    study = as_study(given, "twin.yaml")
    return study, computed(study)


def _noiseless(experiment: dict[str, Any]) -> dict[str, Any]:
    signals = {
        name: {key: value for key, value in signal.items() if key != "noise"}
        for name, signal in experiment["signals"].items()
    }
    return {**experiment, "signals": signals}


def _imp(estimate: list[str], experiment: str, **more: Any) -> dict[str, Any]:
    cost = {"experiment": experiment, "signal": "mlr", "kind": "RMSE"}
    return {**more, "estimate": estimate, "costs": {"RMSE": [cost]}}


def _measured(case: Case, folder: Path) -> Posed:
    """Return measured data: a study of the repository that fits one of its two fluxes."""
    given: dict[str, Any] = copy.deepcopy(dict(read_mapping(CONFIG / f"{case.name}.yaml")))
    imp, fitted = given["imp"], f"capa_{case.number}"
    unseen = {"capa_25": "capa_60", "capa_60": "capa_25"}[fitted]
    given["imp"] = _imp(imp["estimate"], fitted, kinetics=imp["kinetics"])
    given.pop("published", None)
    study = as_study(given, f"{case.name}.yaml")
    results = Results(folder / "studies" / case.name)
    if not results.kinetics("fit.json").exists():
        prepare(study, results)
        fit_kinetics(study, results)
    missing = not results.identification("estimate.csv", "kinetics").exists()
    if study.imp.kinetics == "fitted" and missing:
        identify_kinetics(study, results)
    series = load(study, results)
    return Posed(study, series, fixed_for_imp(study, results), fitted, unseen, series)


REPEATED = {
    ("right", "measured", 0),
    ("right", "measured", 1),
    ("right", "outliers", 0),
    ("wrong", "k_T", 0),
    ("wrong", "back_loss", 1),
    ("measured", "pmma", 25),
}
"""Kind, name and number of the cases that SCE-UA is repeated on."""
PLANS = {"short": (1, 2, 2), "full": (5, 14, 25)}
"""Number of truths of each kind of noise, hidden effects, repetitions of SCE-UA."""


def cases_of(plan: str) -> Iterator[Case]:
    """Yield the cases of a plan."""
    truths, effects, repetitions = PLANS[plan]
    hidden = [("wrong", effect, k % 4) for k, effect in enumerate(HIDDEN[:effects])]
    measured = [("measured", name, flux) for flux in (25, 60) for name in ("pmma", "paper")]
    given = measured[:2]
    for number in range(truths):
        given += [("right", noise, number) for noise in NOISES]
        given += [("known", "measured", number)]
        given += hidden[number::truths]
    given += measured[2:]
    for case in given:
        yield Case(*case, repetitions if case in REPEATED else 0)
