"""What the diagnosis found: windows, candidates, parameters, the gap, the next experiment."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.tables.describe import title_of

Row = Mapping[str, Any]

BASE = "base"
HELD_OUT = "held out"
MOST = 12
"""Candidates and experiments that a table lists."""
CLAIMS = ("named", "ambiguous", "multiple")
"""Verdicts that claim an effect."""
MODELS = {BASE: "base model", "extended": "with the effects found"}
ROLES = {"calibration": "fitted", HELD_OUT: "held out"}
_SHOWN = {"kg/(m² s)": ("g/(m² s)", 1e3), "W/m²": ("kW/m²", 1e-3), "-": ("–", 1.0)}
"""Unit that is shown and what a value is multiplied by, where a unit is shown otherwise."""


def signal_name(signal: str) -> str:
    """Return a signal in words.

    >>> signal_name("mlr"), signal_name("back_temperature")
    ('mass loss rate', 'back temperature')
    """
    return signal.replace("_", " ").replace("mlr", "mass loss rate")


def effect_name(name: str) -> str:
    """Return title and name of an effect.

    >>> effect_name("k_T")
    'slope of the conductivity (k_T)'
    """
    effects = known_effects()
    title = effects[name].title if name in effects else name
    return name if title == name else f"{title} ({name})"


def model_name(effects: Sequence[str]) -> str:
    """Return the effects of a model, titles and names."""
    return " + ".join(effect_name(name) for name in effects)


def shown_unit(unit: str) -> tuple[str, float]:
    """Return the unit that is shown for one of the results, and the factor to it.

    >>> shown_unit("kg/(m2 s)"), shown_unit("K")
    (('g/(m² s)', 1000.0), ('K', 1.0))
    """
    written = unit.replace("m2", "m²")
    return _SHOWN.get(written, (written, 1.0))


def leading(found: Row) -> dict[str, Any] | None:
    """Return the candidate that the verdict rests on, if any: the best with just its effects."""
    effects = set(found["verdict"]["effects"])
    same = [c for c in found["candidates"] if effects and set(c["effects"]) == effects]
    best = sorted(same, key=lambda c: (bool(c["rejected"]), float(c["penalised"])))
    return best[0] if best else None


def remark(found: Row, candidate: Row) -> str:
    """Say why a candidate was rejected, or what it is if it was not."""
    kept = "in the verdict" if found["verdict"]["kind"] in CLAIMS else "not claimed"
    return candidate["rejected"] or kept


def ranked(found: Row) -> list[dict[str, Any]]:
    """Return the candidates, the lowest penalised chi-square first."""
    return sorted(found["candidates"], key=lambda c: float(c["penalised"]))


def windows(study: Study, results: Results) -> pd.DataFrame:
    """List where the simulated curve is off to one side, and what goes on there."""
    return pd.DataFrame([_window(study, w) for w in diagnosis.read(study, results)["windows"]])


def _window(study: Study, w: Row) -> dict[str, Any]:
    unit, factor = shown_unit(w["unit"])
    programme = None if w["start_K"] is None else (w["start_K"], w["end_K"])
    return {
        "model": MODELS.get(w["model"], w["model"]),
        "experiment": title_of(study, w["experiment"]),
        "signal": signal_name(w["signal"]),
        "phase": w["phase"],
        "time_s": between((w["start_s"], w["end_s"]), ".0f"),
        "temperature_K": between(programme or w["surface_temperature_K"], ".0f"),
        "conversion": between(w["conversion"], ".2f"),
        "difference": f"{factor * w['mean']:+.3g} {unit.replace('–', '')}".strip(),
        "relative_percent": np.nan if w["relative"] is None else 100.0 * w["relative"],
    }


def between(pair: Sequence[float] | None, digits: str) -> str | None:
    """Write a range of values, nothing where there is none.

    >>> between([0.1, 0.25], ".2f")
    '0.10 to 0.25'
    """
    return None if pair is None else f"{pair[0]:{digits}} to {pair[1]:{digits}}"


def candidates(study: Study, results: Results) -> pd.DataFrame:
    """List the models with effects that were fitted, the best ones, and why each was rejected."""
    found = diagnosis.read(study, results)
    order = ranked(found)
    lowest = order[0]["penalised"] if order else 0.0
    rows = [
        {
            "model": model_name(c["effects"]),
            "chi2": c["chi2"],
            "gain": c["gain"],
            "above_best": c["penalised"] - lowest,
            "fitted": "; ".join(_fitted(c)),
            "predictions": _predictions(study, c["predictions"]),
            "remark": remark(found, c),
        }
        for c in order[:MOST]
    ]
    columns = ("chi2", "gain", "above_best", "fitted", "predictions", "remark")
    return pd.DataFrame(rows, columns=["model", *columns])


def _fitted(candidate: Row) -> list[str]:
    """Write value and interval of each parameter of a candidate's effects."""
    catalogue, free = known_effects(), candidate["free"]
    said = []
    for effect, names in free.items():
        for name in names:
            strength = name in catalogue[effect].strength
            label = effect if strength else catalogue[effect].quantities[name].label
            p = candidate["parameters"][f"{effect}_{name}"]
            low, high = _widest(p)
            text = f"{p['value']:.3g} ({low:.3g} to {high:.3g}) {p['unit']}".rstrip(" -")
            said.append(text if strength and len(free) == 1 else f"{label} {text}")
    return said


def _widest(p: Row) -> tuple[float, float]:
    """Return the interval, with the uncertainty of the form where it is known."""
    low, high = p.get("low_form"), p.get("high_form")
    return (p["low"] if low is None else low, p["high"] if high is None else high)


def _predictions(study: Study, gains: Mapping[str, float]) -> str:
    names = {name: study.experiments[name].title or name for name in gains if name != HELD_OUT}
    return "; ".join(f"{names.get(name, name)} {gain:+.1f}" for name, gain in gains.items())


def strengths(study: Study, results: Results) -> pd.DataFrame:
    """List the parameters of the effects that the verdict rests on, with their intervals."""
    chosen = leading(diagnosis.read(study, results))
    catalogue = known_effects()
    rows = []
    for effect, free in (chosen["free"] if chosen else {}).items():
        for name in free:
            p = chosen["parameters"][f"{effect}_{name}"] if chosen else {}
            rows.append(
                {
                    "effect": effect_name(effect),
                    "parameter": catalogue[effect].quantities[name].label,
                    "value": p["value"],
                    "low": p["low"],
                    "high": p["high"],
                    "low_form": p["low_form"],
                    "high_form": p["high_form"],
                    "unit": p["unit"],
                    "without": catalogue[effect].quantities[name].value,
                }
            )
    return pd.DataFrame(rows).dropna(axis="columns", how="all")


def parameters(study: Study, results: Results) -> pd.DataFrame:
    """List the parameters of the base, without and with the effects of the verdict."""
    found = diagnosis.read(study, results)
    after = found["extended"]["parameters"] if leading(found) else {}
    rows = [
        {
            "parameter": name,
            "unit": p["unit"],
            "base": p["value"],
            "base_low": p["low"],
            "base_high": p["high"],
            "at_limit": "yes" if p["at_limit"] else "",
            **{key: after[name][of] if name in after else np.nan for key, of in _AFTER.items()},
        }
        for name, p in found["base"]["parameters"].items()
    ]
    return pd.DataFrame(rows).dropna(axis="columns", how="all")


_AFTER = {"extended": "value", "extended_low": "low", "extended_high": "high"}


def gap(study: Study, results: Results) -> pd.DataFrame:
    """List how far model and measurement are apart, before and after, fitted and held out.

    ``before_sd``, ``after_sd``: root of chi-square per point; 1 is noise alone. Without named
    effects there is no after.
    """
    found = diagnosis.read(study, results)
    rows = []
    for g in found["gap"]:
        unit, factor = shown_unit(g["unit"])
        before, after = factor * g["rms_before"], factor * g["rms_after"]
        rows.append(
            {
                "role": ROLES.get(g["role"], g["role"]),
                "experiment": title_of(study, g["experiment"]),
                "signal": signal_name(g["signal"]),
                "points": int(g["points"]),
                "rms_before": before,
                "rms_after": after,
                "noise_sd": factor * g["noise_sd"],
                "unit": unit,
                "closed_percent": 100.0 * (1.0 - after / before) if before > 0.0 else np.nan,
                "before_sd": float(np.sqrt(g["chi2_before"] / g["points"])),
                "after_sd": float(np.sqrt(g["chi2_after"] / g["points"])),
            }
        )
    frame = pd.DataFrame(rows)
    added = bool(found["verdict"]["effects"])
    return frame if added else frame.drop(columns=["rms_after", "closed_percent", "after_sd"])


def noise(study: Study, results: Results) -> pd.DataFrame:
    """List the noise of every channel, and how the base fits or predicts it."""
    rows = []
    for n in diagnosis.read(study, results)["noise"]:
        unit, factor = shown_unit(n["unit"])
        rows.append(
            {
                "role": ROLES.get(n["role"], n["role"]),
                "experiment": title_of(study, n["experiment"]),
                "signal": signal_name(n["signal"]),
                "points": int(n["points"]),
                "sd_median": factor * n["sd_median"],
                "unit": unit,
                "noise": n["words"],
                "chi2_per_point": n["chi2_base"] / n["points"],
            }
        )
    return pd.DataFrame(rows)


def probes(study: Study, results: Results) -> pd.DataFrame:
    """List which free correction inside the model would absorb the misfit, the best first."""
    found = diagnosis.read(study, results)["probes"]
    rows = [{"probe": p["what"], "absorbed_percent": 100.0 * p["absorbed"]} for p in found]
    return pd.DataFrame(rows, columns=["probe", "absorbed_percent"])


def next_experiments(study: Study, results: Results) -> pd.DataFrame:
    """List the experiments that would separate competing models best."""
    found = diagnosis.read(study, results)["next_experiment"]
    rows = [{"experiment": d["words"], "separation_sd": d["separation_sd"]} for d in found]
    frame = pd.DataFrame(rows, columns=["experiment", "separation_sd"])
    return frame.sort_values("separation_sd", ascending=False, ignore_index=True).head(MOST)
