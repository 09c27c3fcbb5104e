"""A small study, and twins of it that hide effects: production solver and drawn noise."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study, TermSpec, as_study
from pyrofit.data.noise import autoregressive, draw_noise, moving_average
from pyrofit.diagnose.base.model import Base, extended, model_of, strength_of
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.problem import make_problem
from pyrofit.estimate.targets import Measurements
from pyrofit.quantities import known_quantities
from pyrofit.solver.arrays import FloatArray

CHANNELS = tuple((s, q) for s in ("slab_25", "slab_60") for q in ("mlr", "back_temperature"))
TIMES = {"slab_25": np.arange(5.0, 1200.0, 10.0), "slab_60": np.arange(2.5, 320.0, 5.0)}
SD = {"mlr": 3e-4, "back_temperature": 1.0}
# As a balance and a thermocouple have it: differenced readings, and an error that lasts.
NOISE = {
    "mlr": lambda n: moving_average((-0.25, -0.2), n),
    "back_temperature": lambda n: autoregressive(0.8, n),
}
TRUTH = {"rho": 1190.0, "k": 0.2, "cp": 2100.0, "eps": 0.9, "dh": 8e5}
"""SI units."""
LIMITS = {
    "rho": ("kg/m3", 900, 1500),
    "k": ("W/(m K)", 0.1, 0.4),
    "cp": ("kJ/(kg K)", 1.0, 3.0),
    "eps": ("-", 0.5, 0.99),
    "dh": ("kJ/kg", 250, 1500),
}


def _slab(name: str, flux: float, average_s: float) -> dict[str, Any]:
    return {
        "kind": "gasification",
        "sample": {
            "layers": [{"thickness_m": 0.004}],
            "foil": {"thickness_m": 2.5e-5, "density_kg_m3": 8940, "specific_heat_J_kgK": 380},
            "initial_temperature_K": 295,
        },
        "front": {"flux_W_m2": flux, "h_W_m2K": 8, "gas_temperature_K": 330},
        "back": {"h_W_m2K": 4, "emissivity": 0.95, "gas_temperature_K": 300},
        "signals": {
            q: {
                "file": f"{name}_{q}.csv",
                **known_quantities()[q].tidy_keys(),
                **({"average_s": average_s} if q == "mlr" else {}),
            }
            for q in SD
        },
    }


def given(known: dict[str, Any] | None = None, **diagnosis: Any) -> dict[str, Any]:
    """Return the keys of the study: both slabs fitted, kinetics fixed."""
    keys: dict[str, Any] = {
        "name": "small",
        "seed": 5,
        "parameters": {n: {"unit": u, "lower": a, "upper": b} for n, (u, a, b) in LIMITS.items()},
        "material": {
            "components": {
                "polymer": {
                    "density_kg_m3": "rho",
                    "conductivity_W_mK": "k",
                    "specific_heat_J_kgK": "cp",
                    "emissivity": "eps",
                }
            },
            "reactions": {
                "pyrolysis": {
                    "reactant": "polymer",
                    "reference_temperature_K": 605,
                    "reference_rate_1_s": 0.001,
                    "E_J_mol": 190e3,
                    "heat_of_reaction_J_kg": "dh",
                }
            },
            "composition": {"polymer": 1.0},
        },
        "experiments": {
            "slab_25": _slab("slab_25", 25e3, 10),
            "slab_60": _slab("slab_60", 60e3, 5),
        },
        "accuracy": {"cells": 20, "tolerance": 2e-3},
        "imp": {
            "estimate": list(LIMITS),
            "costs": {"RMSE": [{"experiment": "slab_25", "signal": "mlr", "kind": "RMSE"}]},
        },
        "validation": {"experiments": ["slab_25"]},
        "known": known or {},
        "diagnosis": {
            "calibrate": {"slab_25": list(SD), "slab_60": list(SD)},
            **diagnosis,
        },
    }
    return json.loads(json.dumps(keys))  # type: ignore[no-any-return]


def study(**diagnosis: Any) -> Study:
    return as_study(given(**diagnosis), "small.yaml")


def base_of(described: Study, curves: list[FloatArray] | None = None) -> Base:
    """Return the base with white noise of known size, measured at zero where no curves are."""
    frames = {}
    for i, (name, quantity) in enumerate(CHANNELS):
        value = np.zeros(TIMES[name].size) if curves is None else curves[i]
        frames[name, quantity] = pd.DataFrame(
            {"time_s": TIMES[name], known_quantities()[quantity].column: value}
        )
    terms = [TermSpec(experiment=e, signal=q, kind="RMSE") for e, q in CHANNELS]
    problem = make_problem(described, tuple(LIMITS), terms, frames, described.material, {})
    noise = tuple(NoiseModel(np.full(TIMES[e].size, SD[q]), Correlation()) for e, q in CHANNELS)
    return Base(Likelihood(problem, noise), tuple(range(len(CHANNELS))))


def truth_of(base: Base, hidden: Mapping[str, float]) -> FloatArray:
    """Return the truth as fractions of the search range, effects last."""
    likelihood = base.likelihood
    x = likelihood.scaled(np.array([TRUTH[name] for name in likelihood.problem.names]))
    for effect, strength in hidden.items():
        x = extended(x, effect, strength)
    return x


def clean(hidden: Mapping[str, float]) -> list[FloatArray]:
    """Return the true curves of all channels with effects at given strengths [SI]."""
    base = base_of(study())
    model = model_of(base, {effect: (strength_of(effect)[0],) for effect in hidden})
    curves = model.likelihood.curves(truth_of(base, hidden))
    assert curves is not None
    return model.likelihood.split(curves)


def measured(hidden: Mapping[str, float], seed: int) -> Measurements:
    """Return measurements of a truth with hidden effects, their uncertainty stated."""
    rng = np.random.default_rng(seed)
    frames = {}
    for (name, quantity), curve in zip(CHANNELS, clean(hidden), strict=True):
        noise = SD[quantity] * draw_noise(NOISE[quantity](curve.size), rng)
        frames[name, quantity] = pd.DataFrame(
            {
                "time_s": TIMES[name],
                known_quantities()[quantity].column: curve + noise,
                known_quantities()[quantity].uncertainty_column: SD[quantity],
            }
        )
    return frames
