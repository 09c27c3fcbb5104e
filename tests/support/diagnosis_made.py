"""A diagnosis as it is written, for the tests of its page."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from shown_studies import fake

from pyrofit.config import Study
from pyrofit.diagnose.base.model import strength_of
from pyrofit.effects import known_effects
from pyrofit.results.files import Results, write_csv, write_json

CHANNELS = (
    ("slow", "mass_fraction", "calibration"),
    ("slab_25", "mlr", "calibration"),
    ("slab_60", "mlr", "calibration"),
    ("slab_60", "back_temperature", "held out"),
)


UNITS = {"mlr": "kg/(m2 s)", "mass_fraction": "-", "back_temperature": "K"}


NOISE = {"mlr": 3e-4, "mass_fraction": 0.005, "back_temperature": 1.0}


EFFECTS = ("k_T", "c_T", "heater_ramp", "time_offset", "front_convection", "melting")


EFFECTS_OF = {
    "none": [],
    "named": ["k_T"],
    "ambiguous": ["heater_ramp"],
    "multiple": ["k_T", "melting"],
    "partly": ["k_T"],
    "unknown": [],
}


SETS = {"ambiguous": [["heater_ramp", "time_offset"]], "multiple": [["k_T", "c_T"], ["melting"]]}


def diagnosed(root: Path, kind: str, given: dict[str, Any] | None = None) -> tuple[Study, Results]:
    """Write the results of a diagnosis with a verdict."""
    study, results = fake(root, given)
    write_json(results.diagnosis("diagnosis.json"), found(study, kind))
    write_csv(results.diagnosis("curves.csv"), curves(study, kind))
    return study, results


def channels(study: Study) -> list[tuple[str, str, str]]:
    return [c for c in CHANNELS if c[1] in study.experiments[c[0]].signals]


def found(study: Study, kind: str) -> dict[str, Any]:
    quiet, effects = kind == "none", EFFECTS_OF[kind]
    extended = {**parameter(0.31, "W/(m K)"), "at_limit": False}
    return {
        "schema": 1,
        "settings": {},
        "study": study.name,
        "verdict": {
            "kind": kind,
            "effects": effects,
            "groups": ["conductivity with temperature"] * len(effects),
            "forms": ["linear in temperature"] * len(effects),
            "sets": SETS.get(kind, [[name] for name in effects]),
            "evidence": [
                {
                    "agreement": 0.4,
                    "predictions": {"slab_60": 12.0, "held out": -1.5},
                    "expected": {"slab_60": 14.0, "held out": 0.6},
                    "known": {"k": [0.4, 2.5]},
                    "implausible": 0.0,
                    "weight": 0.97,
                }
                for _ in effects
            ],
            "other_terms": [
                [{"words": "another heat loss of the front", "above": 40.0}] * (kind == "named")
                for _ in effects
            ],
            "confirmed": kind == "named",
            "words": f"These are the words of {kind}.",
            "reasons": [] if quiet else ["chi-square falls by 400.", "predictions improve"],
            "suspects": [{"effect": "c_T", "gain": 40.0}] if kind == "partly" else [],
            "taken_away": [{"effect": "c_T", "reason": "predictions do not improve"}]
            * (kind == "partly"),
            "weights": {"conductivity with temperature": 0.97, "heat capacity": 0.02},
        },
        "noise": [noise_of(c) for c in channels(study)],
        "solver": {"coarsened": True, "error_chi2": 0.1},
        "not_tried": [{"effect": "tga_lag", "reason": "no calibrated signal can show it"}],
        "extended": {"parameters": {} if quiet else {"k": extended}},
        "base": {
            "chi2": 330.0 if quiet else 2000.0,
            "points": 320,
            "chi2_critical": 380.0,
            "scan": 2.0 if quiet else 12.0,
            "scan_critical": 2.5,
            "score": 1.0 if quiet else 30.0,
            "score_critical": 3.3,
            "adequate": quiet,
            "parameters": {
                "k": parameter(0.25, "W/(m K)", at_limit=False),
                "cp": parameter(3.5, "kJ/(kg K)", at_limit=not quiet),
            },
        },
        "windows": [] if quiet else windows(study),
        "screen": [screened(i, name) for i, name in enumerate(EFFECTS)],
        "confusability": {"effects": list(EFFECTS), "cosine": cosine()},
        "needed": 12.4,
        "ambiguity": 9.0,
        "candidates": candidates(kind),
        "gap": [gap_of(c, effects) for c in channels(study)],
        "kinetics_alone": [
            {"parameter": "k", "alone": 0.2, "sd": 0.01, "all": 0.3, "difference": 10.0}
        ],
        "profiles": [profile_of(effect) for effect in effects],
        "probes": probes() if kind == "unknown" else [],
        "next_experiment": designs() if kind == "ambiguous" else [],
        "extended_study": "extended.yaml" if effects else "",
    }


def profile_of(effect: str) -> dict[str, Any]:
    ((parameter, quantity),) = known_effects()[effect].strength.items()
    strengths = np.sort(quantity.typical * np.array([0.8, 0.9, 1.0, 1.1, 1.2]))
    return {
        "effect": effect,
        "parameter": parameter,
        "unit": quantity.unit,
        "value": strengths.tolist(),
        "rise": [6.0, 1.5, 0.0, 1.5, 6.0],
        "level": 3.84,
        "low": quantity.typical - 0.16 * abs(quantity.typical),
        "high": quantity.typical + 0.16 * abs(quantity.typical),
        "low_open": False,
        "high_open": False,
    }


def noise_of(channel: tuple[str, str, str]) -> dict[str, Any]:
    experiment, signal, role = channel
    place = {"experiment": experiment, "signal": signal, "role": role, "unit": UNITS[signal]}
    told = {"stated": signal != "mass_fraction", "white": signal != "mlr"}
    return {
        **place,
        "points": 80,
        "sd_median": NOISE[signal],
        "words": "white",
        "chi2_base": 480.0,
        **told,
    }


def gap_of(channel: tuple[str, str, str], effects: list[str]) -> dict[str, Any]:
    experiment, signal, role = channel
    sd = NOISE[signal]
    after = 1.0 if effects else 5.0
    return {
        "experiment": experiment,
        "signal": signal,
        "role": role,
        "tells": True if effects and role == "held out" else None,
        "points": 80,
        "unit": UNITS[signal],
        "noise_sd": sd,
        "rms_before": 4.0 * sd,
        "rms_after": after * sd,
        "chi2_before": 80 * 25.0,
        "chi2_after": 80 * after**2,
    }


def parameter(value: float, unit: str, **more: Any) -> dict[str, Any]:
    return {"value": value, "low": 0.9 * value, "high": 1.1 * value, "unit": unit, **more}


def windows(study: Study) -> list[dict[str, Any]]:
    """Windows close to each other, a short one, and one of a TGA."""
    phases = ["heat-up", "onset", "onset", "plateau", "burn-out", "tail"]
    starts = [5.0, 60.0, 100.0, 130.0, 330.0, 355.0]
    ends = [60.0, 80.0, 120.0, 320.0, 352.0, 380.0]
    slab = [
        {
            **window("slab_25", "mlr", phase, start, end),
            "start_K": None,
            "end_K": None,
            "surface_temperature_K": [400.0, 500.0],
            "model": model,
        }
        for model in ("base", "extended")
        for phase, start, end in zip(phases, starts, ends, strict=True)
        if model == "base" or phase == "tail"
    ]
    tga = {"start_K": 620.0, "end_K": 680.0, "surface_temperature_K": None}
    return [*slab, {**window("slow", "mass_fraction", "onset", 1500.0, 2400.0), **tga}]


def window(experiment: str, signal: str, phase: str, start: float, end: float) -> dict[str, Any]:
    return {
        "model": "base",
        "experiment": experiment,
        "signal": signal,
        "start_s": start,
        "end_s": end,
        "conversion": [0.1, 0.25],
        "phase": phase,
        "sign": -1,
        "mean": -2.0 * NOISE[signal],
        "relative": -0.12,
        "unit": UNITS[signal],
        "statistic": 7.5,
        "critical": 2.5,
    }


def screened(i: int, name: str) -> dict[str, Any]:
    family = ("material", "material", "apparatus", "apparatus", "environment", "material")[i]
    return {
        "effect": name,
        "group": "a group",
        "family": family,
        "detectability": 3.0 * 2.0**i,
        "typical": 1.0,
        "unit": "-",
        "z": 30.0 / (i + 1) if i else 0.0,
        "ahead": 10.0,
    }


def cosine() -> list[list[float]]:
    matrix = np.eye(len(EFFECTS))
    matrix[2, 3] = matrix[3, 2] = -0.998
    matrix[0, 1] = matrix[1, 0] = 0.7
    return [[float(value) for value in row] for row in matrix]


def candidates(kind: str) -> list[dict[str, Any]]:
    """Every effect alone, the leading one with a form free, a pair; the best is no first."""
    kept, quiet = EFFECTS_OF[kind], kind == "none"
    alone = [({name: strength(name)}, 1900.0 - 10 * i) for i, name in enumerate(EFFECTS)]
    form = ({"melting": (*strength("melting"), "temperature_K")}, 1700.0)
    pair = ({"k_T": strength("k_T"), "melting": strength("melting")}, 400.0)
    tried = [*alone, form, pair]
    made = []
    for free, chi2 in tried:
        effects = list(free)
        best = effects == kept or (kind == "ambiguous" and effects[0] in SETS[kind][0])
        count = sum(len(names) for names in free.values())
        lower = 350.0 if best else 328.0 if quiet else chi2
        made.append(
            {
                "effects": effects,
                "free": {name: list(names) for name, names in free.items()},
                "chi2": lower,
                "gain": (330.0 if quiet else 2000.0) - lower,
                "penalised": lower + count * float(np.log(320)),
                "parameters": {
                    f"{effect}_{name}": {
                        **parameter(-0.00123, "1/K"),
                        "low_wide": -0.005,
                        "high_wide": 0.004,
                    }
                    for effect, names in free.items()
                    for name in names
                },
                "ridges": [],
                "adequate": best,
                "disagree": 0.25 if best else None,
                "predictions": {"slab_60": 12.0, "held out": -1.5} if best else {},
                "explains": True if best else None,
                "rejected": "" if best else "chi-square is 1500 above that of the best",
            }
        )
    return made


def strength(name: str) -> tuple[str, ...]:
    return (strength_of(name)[0],)


def probes() -> list[dict[str, Any]]:
    shapes = {
        "flux": ("a factor on the external flux that varies over time", "-"),
        "front_heat_loss": ("another heat loss of the front", "W/m2"),
    }
    return [
        {
            "probe": name,
            "what": what,
            "chi2": 500.0,
            "absorbed": 0.83,
            "shape": [[300.0, -0.1], [400.0, 0.05], [600.0, 0.2]],
            "unit": unit,
        }
        for name, (what, unit) in shapes.items()
    ]


def designs() -> list[dict[str, Any]]:
    return [
        {
            "design": f"d{i}",
            "words": words,
            "separation_sd": sd,
            "pairs": {"heater_ramp / time_offset": sd},
        }
        for i, (words, sd) in enumerate(
            (
                ("gasification at half the flux", 0.7),
                ("gasification at 90 kW/m² with the back temperature", 6.4),
            )
        )
    ]


def curves(study: Study, kind: str) -> pd.DataFrame:
    rng = np.random.default_rng(3)
    frames = []
    for experiment, signal, role in channels(study):
        time = np.arange(5.0, 405.0, 5.0)
        shape = np.exp(-(((time - 250.0) / 80.0) ** 2))
        scale = {"mlr": 0.012, "mass_fraction": 1.0, "back_temperature": 400.0}[signal]
        sd = NOISE[signal]
        noise = sd * rng.standard_normal(time.size)
        off = 0.0 if kind == "none" else 5.0 * sd * np.sin(time / 50.0)
        true = scale * (1.0 - time / 405.0 if signal == "mass_fraction" else shape)
        after = true if EFFECTS_OF[kind] else np.nan
        frames.append(
            pd.DataFrame(
                {
                    "experiment": experiment,
                    "signal": signal,
                    "role": role,
                    "time_s": time,
                    "temperature_K": 500.0 + time / 2 if signal == "mass_fraction" else np.nan,
                    "measured": true + noise,
                    "sd": sd,
                    "before": true + off,
                    "after": after,
                }
            )
        )
    return pd.concat(frames)
