"""The table of the blind test: verdict and hidden effects of every twin."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.effects import known_effects, same_as
from pyrofit.results.files import read_json
from pyrofit.results.needed import Keys
from pyrofit_blind_test.places import Places

CLAIMS = ("named", "ambiguous", "multiple", "partly")
"""Verdicts that claim a missing effect."""
Verdict = Mapping[str, Any]
_NEEDS: dict[Keys, type] = {
    ("id",): str,
    ("case",): dict,
    ("detectability",): float,
    ("location",): dict,
    ("seconds", "diagnosis"): float,
    ("score_only",): str,
    ("verdict", "kind"): str,
    ("verdict", "confirmed"): bool,
    ("verdict", "effects"): list,
    ("verdict", "sets"): list,
    ("gap",): list,
    ("candidates",): list,
}


def twins(places: Places, cases: Iterable[str]) -> pd.DataFrame:
    """Return one row for each diagnosed twin, see `row_of`.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    return pd.DataFrame([row_of(read_json(places.case(case), _NEEDS)) for case in sorted(cases)])


def diagnosed_twins(places: Places, chunks: int) -> list[str]:
    """Return the names of the twins of all jobs of a plan.

    Raises
    ------
    DataError
        A job has not been run.
    """
    needs: dict[Keys, type] = {("cases",): list}
    found = [read_json(places.chunk(chunk), needs)["cases"] for chunk in range(chunks)]
    return [str(case) for part in found for case in part]


def row_of(found: Mapping[str, Any]) -> dict[str, object]:
    """Compare the verdict on a twin with its hidden effects.

    A claim is right if every leading effect is hidden, or describes an error of the description;
    the best fit leads an ambiguous set. A second effect that is not hidden makes a claim wrong.
    Effects that these signals can never distinguish count as one (`same_as`), in sets as well.
    """
    case, verdict = found["case"], found["verdict"]
    hidden = set(case["hidden"])
    named = leading_effects(verdict)
    claim, right = bool(named), right_claim(found)
    listed = _one_name({*verdict["effects"], *(n for names in verdict["sets"] for n in names)})
    score_only = {found["score_only"]} - {""}
    return {
        "id": found["id"],
        **{key: case[key] for key in ("kind", "strength", "signals", "noise", "seed")},
        "curves": case["curves"],
        "error": case.get("error", ""),
        "hidden": " + ".join(sorted(hidden)),
        "group": " + ".join(sorted(_groups(hidden))),
        "is_candidate": not hidden & set(case["without"]),
        "detectability": found["detectability"],
        "verdict": verdict["kind"],
        "named": " + ".join(named),
        "named_group": " + ".join(sorted(_groups(named))),
        "claim": claim,
        "unknown": verdict["kind"] == "unknown",
        "confirmed": claim and bool(verdict["confirmed"]),
        "right": right,
        "wrong": claim and not right,
        "surely_wrong": claim and bool(verdict["confirmed"]) and not right,
        "noticed": verdict["kind"] != "none",
        "group_right": claim and _groups(named) <= _groups(hidden),
        "all_lead": claim and _one_name(named) == _one_name(hidden),
        "in_set": claim and bool(hidden) and _one_name(hidden) <= listed,
        "set_size": _set_size(verdict) if claim else np.nan,
        "score_only": found["score_only"],
        "score_only_right": bool(score_only) and _one_name(score_only) <= _one_name(hidden),
        **_gaps(found["gap"]),
        **_held_out_gain(found["candidates"]),
        **_left_out(hidden, found.get("left_out")),
        **_location(found["location"]),
        "seconds": found["seconds"]["diagnosis"],
    }


def right_claim(found: Mapping[str, Any]) -> bool:
    """Tell whether a verdict names effects, and every one of them is hidden.

    An effect that describes an error of the description counts as hidden.
    """
    named, case = leading_effects(found["verdict"]), found["case"]
    return bool(named) and _one_name(named) <= _one_name({*case["hidden"], *case.get("same", ())})


def leading_effects(verdict: Verdict) -> list[str]:
    """Return the leading effect of each finding of a verdict, none if it makes no claim."""
    return [str(name) for name in verdict["effects"]] if verdict["kind"] in CLAIMS else []


def one_name(effect: str) -> str:
    """Return one name for effects that no signal can distinguish.

    >>> one_name("time_offset"), one_name("k_T")
    ('heater_ramp', 'k_T')
    """
    return min(same_as(effect))


def _one_name(effects: Iterable[str]) -> set[str]:
    return {one_name(effect) for effect in effects}


def _groups(effects: Iterable[str]) -> set[str]:
    catalogue = known_effects()
    return {catalogue[effect].group for effect in effects}


def _set_size(verdict: Verdict) -> float:
    sizes = [float(len(_one_name(names))) for names in verdict["sets"]]
    return float(np.mean(sizes)) if sizes else np.nan


def _gaps(gap: list[Mapping[str, Any]]) -> dict[str, float]:
    """Return root mean squares of the whitened residuals before and after, by role."""
    row = {}
    for role in ("calibration", "held out"):
        here = [entry for entry in gap if entry["role"] == role]
        points = sum(entry["points"] for entry in here)
        for when in ("before", "after"):
            total = sum(entry[f"chi2_{when}"] for entry in here)
            name = f"{role.replace(' ', '_')}_{when}"
            row[name] = float(np.sqrt(total / points)) if points else np.nan
    return row


def _held_out_gain(candidates: list[Mapping[str, Any]]) -> dict[str, object]:
    """Return the gain of the claimed model in the log score of the held-out experiment."""
    gains = (c["predictions"].get("held out") for c in candidates if not c["rejected"])
    gain = next((gain for gain in gains if gain is not None), np.nan)
    return {"held_out_gain": gain, "held_out_better": bool(gain > 0.0)}


def _location(counts: Mapping[str, int]) -> dict[str, float]:
    """Return precision, recall and F1 of the windows, none where the base misses nothing."""
    found, off, both = (counts[name] for name in ("in_windows", "off", "both"))
    return {
        "window_precision": both / found if off and found else np.nan,
        "window_recall": both / off if off else np.nan,
        "window_f1": 2 * both / (found + off) if off else np.nan,
    }


def _left_out(hidden: set[str], verdict: Verdict | None) -> dict[str, object]:
    """Judge the diagnosis whose candidates lack a hidden effect.

    It is wrong if it names an effect of another group with certainty. ``kept_named`` tells whether
    it names a hidden effect that it considers.
    """
    if verdict is None:
        return {
            "left_out": "",
            "left_out_named": "",
            "left_out_wrong": False,
            "kept_named": False,
        }
    named = leading_effects(verdict) if verdict["confirmed"] else []
    return {
        "left_out": verdict["kind"],
        "left_out_named": " + ".join(named),
        "left_out_wrong": not _groups(named) <= _groups(hidden),
        "kept_named": bool(_one_name(named) & _one_name(hidden)),
    }
