"""Records of known truth: curves of a scheme with the noise that repeats of one laboratory show."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study, TermSpec, as_study
from pyrofit.errors import StudyError, suggest
from pyrofit.estimate.targets import Measurements
from pyrofit.numerics import functions
from pyrofit.quantities import quantities_of
from pyrofit.scheme.arrangements.base import PREFIX
from pyrofit.scheme.fit import SchemeSetting, problem_of
from pyrofit.scheme.posed import pose_scheme
from pyrofit.scheme.records import MassRecord, records_of
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.settings import SchemeSettings
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.outputs import MASS_FRACTION

TEMPERATURES_K = np.arange(320.0, 761.0, 1.0)
FITTED_RATES = (1.0, 10.0, 50.0)
HELD_OUT_RATES = (2.0, 5.0, 20.0, 100.0)


@dataclass(frozen=True, eq=False)
class SchemeTwin:
    """A study with computed records, and their clean curves by experiment, as fits see them."""

    setting: SchemeSetting
    scheme: Scheme
    truth: Mapping[str, float]
    clean: Mapping[str, FloatArray]


def study_of(fitted: Sequence[float], held_out: Sequence[float], seed: int) -> Study:
    """Return a study with a material of one reaction and records at some rates [K/min]."""
    heated = {name_at_rate(rate): _heated(rate) for rate in (*fitted, *held_out)}
    shown = next(iter(quantities_of("gasification")))
    # Every study has an inverse modelling; of this one only the kinetics are used.
    mass = {"signal": MASS_FRACTION, "kind": "RMSE"}
    given = {
        "name": "scheme_twin",
        "seed": seed,
        "parameters": {
            "T": {"unit": "K", "lower": 500.0, "upper": 700.0},
            "E": {"unit": "kJ/mol", "lower": 80.0, "upper": 350.0},
            "k": {"unit": "W/(m K)", "lower": 0.1, "upper": 0.4},
        },
        "material": _material(),
        "experiments": {**heated, "slab": _slab(shown)},
        "kinetics": {
            "estimate": ["T", "E"],
            "cost": [{"experiment": name_at_rate(rate), **mass} for rate in fitted],
            "compare": [name_at_rate(rate) for rate in held_out],
        },
        "imp": {
            "estimate": ["k"],
            "kinetics": "fitted",
            "costs": {"RMSE": [{"experiment": "slab", "signal": shown, "kind": "RMSE"}]},
        },
        "validation": {"experiments": ["slab"]},
    }
    return as_study(given, "scheme_twin.json")


def _heated(rate: float) -> dict[str, Any]:
    return {
        "kind": "tga",
        "heating_rate_K_min": rate,
        "signals": {MASS_FRACTION: {"file": f"{name_at_rate(rate)}.csv"}},
    }


def _slab(signal: str) -> dict[str, Any]:
    return {
        "kind": "gasification",
        "sample": {"layers": [{"thickness_m": 0.006}], "initial_temperature_K": 300.0},
        "front": {"flux_W_m2": 25000.0, "gas_temperature_K": 300.0},
        "back": {"gas_temperature_K": 300.0},
        "signals": {signal: {"file": "slab.csv"}},
    }


def _material() -> dict[str, Any]:
    inert = {"density_kg_m3": 1200.0, "conductivity_W_mK": 0.2, "specific_heat_J_kgK": 1500.0}
    reaction = {
        "reactant": "A",
        "products": {"residue": 0.002},
        "reference_temperature_K": "T",
        "reference_rate_1_s": 0.001,
        "E_J_mol": "E",
    }
    return {
        "components": {"A": {**inert, "conductivity_W_mK": "k"}, "residue": inert},
        "reactions": {"A": reaction},
        "composition": {"A": "rest"},
    }


def name_at_rate(rate: float) -> str:
    """Return the experiment's name at a heating rate [K/min].

    >>> name_at_rate(2.5)
    'tga_2_5'
    """
    return f"tga_{rate:g}".replace(".", "_")


def draw_truth(scheme: Scheme, rng: np.random.Generator) -> dict[str, float]:
    """Draw the parameters of a scheme, SI units; every feature is one that can be seen."""
    truth: dict[str, float] = {}
    first = rng.uniform(585.0, 615.0)
    for i in range(1, scheme.reactions + 1):
        apart = 0.0 if i == 1 else rng.uniform(-45.0, -25.0) * (i - 1)
        truth[f"T_{i}"] = first + apart
        truth[f"E_{i}"] = rng.uniform(1.5e5, 2.5e5)
        truth[f"n_{i}"] = rng.choice([rng.uniform(0.5, 0.75), rng.uniform(1.4, 2.2)])
        truth[f"w_{i}"] = rng.uniform(0.1, 0.3)
        truth[f"y_{i}"] = rng.uniform(0.3, 0.6)
    if scheme.arrangement == "consecutive":  # an intermediate that reacts more slowly is seen
        for i in range(2, scheme.reactions + 1):
            truth[f"T_{i}"] = first + rng.uniform(15.0, 30.0) * (i - 1)
    truth["K"] = rng.uniform(5.0, 40.0)
    truth["volatile_share"] = rng.uniform(0.02, 0.06)
    truth["volatile_temperature_K"] = rng.uniform(430.0, 490.0)
    truth["volatile_E_J_mol"] = rng.uniform(0.8e5, 1.4e5)
    truth["lag"] = rng.uniform(5.0, 15.0)
    return {PREFIX + key: float(value) for key, value in truth.items()}


def make_scheme_twin(scheme: Scheme, seed: int, settings: SchemeSettings) -> SchemeTwin:
    """Return a twin whose truth is a scheme, with drawn parameters and noise."""
    rng = np.random.default_rng(seed)
    study = study_of(FITTED_RATES, HELD_OUT_RATES, seed)
    truth = draw_truth(scheme, rng)
    blank = {
        (name_at_rate(rate), MASS_FRACTION): _frame(
            rate, np.linspace(1.0, 0.0, TEMPERATURES_K.size)
        )
        for rate in (*FITTED_RATES, *HELD_OUT_RATES)
    }
    measured, clean = dict(blank), {}
    for name, signal in blank:
        exact = simulated_masses(study, scheme, truth, blank, name, settings)
        rate = study.experiments[name].heating_rate_K_min  # type: ignore[union-attr]
        measured[name, signal] = _frame(rate, exact + _noise(exact, settings, rng))
        clean[name] = exact
    records = tuple(records_of(study, measured, settings.points))
    seen = {
        r.experiment: np.interp(r.temperature_K, TEMPERATURES_K, clean[r.experiment])
        for r in records
    }
    return SchemeTwin(SchemeSetting(study, measured, records, settings), scheme, truth, seen)


def simulated_masses(
    study: Study,
    scheme: Scheme,
    values: Mapping[str, float],
    measurements: Measurements,
    name: str,
    settings: SchemeSettings,
) -> FloatArray:
    """Return the mass over the initial mass of a scheme at every temperature of a record."""
    records = records_of(study, measurements, settings.points)
    term = TermSpec(experiment=name, signal=MASS_FRACTION, kind="RMSE")
    whole = [_with_term(r, term) for r in records if r.experiment == name]
    posed = pose_scheme(study, scheme, records, settings)
    problem, _ = problem_of(
        SchemeSetting(study, measurements, tuple(records), settings), posed, whole
    )
    x = np.array([values[n] for n in posed.names])
    status, models = problem.simulate(x)
    assert status.finished
    return models[0]


def _with_term(record: MassRecord, term: TermSpec) -> MassRecord:
    return MassRecord(**{**vars(record), "term": term})


def _frame(rate: float, mass: FloatArray) -> pd.DataFrame:
    time = (TEMPERATURES_K - TEMPERATURES_K[0]) * 60.0 / rate
    return pd.DataFrame({"time_s": time, "temperature_K": TEMPERATURES_K, MASS_FRACTION: mass})


def _noise(mass: FloatArray, settings: SchemeSettings, rng: np.random.Generator) -> FloatArray:
    """Return scatter of points, drift of the balance, and a shift of the temperature."""
    steps = np.diff(TEMPERATURES_K, prepend=TEMPERATURES_K[0])
    memory = functions.exp(-steps / settings.drift_length_K)
    drift = np.empty(mass.size)
    last = rng.standard_normal()
    for i, keep in enumerate(memory):
        last = keep * last + np.sqrt(1.0 - keep**2) * rng.standard_normal()
        drift[i] = last
    shift = settings.repeat_shift_K * rng.standard_normal()
    moved = np.interp(TEMPERATURES_K + shift, TEMPERATURES_K, mass) - mass
    scatter = settings.scatter * rng.standard_normal(mass.size)
    return np.asarray(moved + settings.drift * drift + scatter)


def all_schemes(most_reactions: int) -> dict[str, Scheme]:
    """Return every scheme by name."""
    found = {Scheme()}
    ahead = [Scheme()]
    while ahead:
        new = set(ahead.pop().extensions(most_reactions, lag=True)) - found
        found |= new
        ahead += new
    return {scheme.name: scheme for scheme in sorted(found)}


def scheme_named(name: str, most_reactions: int) -> Scheme:
    """Return a scheme by its name.

    Raises
    ------
    StudyError
        There is none of this name.
    """
    known = all_schemes(most_reactions)
    if name not in known:
        raise StudyError(f"unknown scheme '{name}'. {suggest(name, known)}")
    return known[name]
