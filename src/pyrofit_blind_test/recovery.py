"""How near the diagnosis of each twin comes to its truth: strengths, base parameters, windows."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.effects import known_effects
from pyrofit.results.files import read_json
from pyrofit.results.needed import Keys
from pyrofit_blind_test.places import Places
from pyrofit_blind_test.table import leading_effects, right_claim

Found = Mapping[str, Any]
STRENGTHS = (
    *("id", "kind", "signals", "noise", "effect", "parameter", "right", "truth", "value"),
    *("low", "high", "covered", "low_wide", "high_wide", "covered_wide"),
)
PARAMETERS = (
    *("id", "kind", "signals", "right", "parameter", "unit", "truth"),
    *("before", "before_off", "before_covered", "after", "after_off", "after_covered"),
)
_NEEDS: dict[Keys, type] = {
    ("case",): dict,
    ("truth",): dict,
    ("base", "parameters"): dict,
    ("extended", "parameters"): dict,
    ("candidates",): list,
    ("verdict", "kind"): str,
    ("verdict", "effects"): list,
}


def recovered_strengths(places: Places, cases: Iterable[str]) -> pd.DataFrame:
    """Return one row for each hidden effect that is named, see `strength_rows`.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    return _table(
        STRENGTHS, (row for found in _read(places, cases) for row in strength_rows(found))
    )


def recovered_parameters(places: Places, cases: Iterable[str]) -> pd.DataFrame:
    """Return one row for each parameter of each twin with hidden effects, see `parameter_rows`.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    found = _read(places, cases)
    return _table(PARAMETERS, (row for one in found for row in parameter_rows(one)))


def _read(places: Places, cases: Iterable[str]) -> Iterator[Found]:
    return (read_json(places.case(case), _NEEDS) for case in sorted(cases))


def _table(columns: tuple[str, ...], rows: Iterator[dict[str, object]]) -> pd.DataFrame:
    return pd.DataFrame(list(rows), columns=list(columns))


def strength_rows(found: Found) -> Iterator[dict[str, object]]:
    """Compare the strengths of named effects with the truth, SI units.

    ``low`` to ``high`` is the 95 % interval of the strength in the model that was fitted.
    ``low_wide`` to ``high_wide`` is the one over other forms and models, if any. An effect of the
    same signature under another name has no true strength, nor has one that another code computes
    in another form.
    """
    case = found["case"]
    if case["curves"] and case["kind"] == "form":
        return
    for effect in leading_effects(found["verdict"]):
        if effect not in case["hidden"]:
            continue
        (parameter,) = known_effects()[effect].strength
        truth = float(case["hidden"][effect][parameter])
        given = fitted_strengths(found).get(f"{effect}_{parameter}")
        if given is None:
            continue
        is_wide = given["low_wide"] is not None
        low, high = (given[key + ("_wide" if is_wide else "")] for key in ("low", "high"))
        yield {
            "id": found["id"],
            **{key: case[key] for key in ("kind", "signals", "noise")},
            "effect": effect,
            "parameter": parameter,
            "right": right_claim(found),
            "truth": truth,
            **{key: given[key] for key in ("value", "low", "high")},
            "covered": given["low"] <= truth <= given["high"],
            "low_wide": low if is_wide else np.nan,
            "high_wide": high if is_wide else np.nan,
            "covered_wide": low <= truth <= high,
        }


def fitted_strengths(found: Found) -> Mapping[str, Any]:
    """Return the parameters of the effects of the model that a verdict claims."""
    named = set(found["verdict"]["effects"])
    same = [c for c in found["candidates"] if set(c["effects"]) == named]
    kept = [c for c in same if not c["rejected"]]
    chosen: list[Mapping[str, Any]] = [*kept, *same, {"parameters": {}}]
    parameters: Mapping[str, Any] = chosen[0]["parameters"]
    return parameters


def parameter_rows(found: Found) -> Iterator[dict[str, object]]:
    """Compare base parameters without and with the effects that were found with the truth.

    The error ``off`` is (fitted - truth) / truth. Nothing is compared where nothing is hidden.
    """
    case = found["case"]
    if not case["hidden"]:
        return
    for name, before in found["base"]["parameters"].items():
        truth = float(found["truth"][name])
        after = found["extended"]["parameters"].get(name)
        yield {
            "id": found["id"],
            **{key: case[key] for key in ("kind", "signals")},
            "right": right_claim(found),
            "parameter": name,
            "unit": before["unit"],
            "truth": truth,
            **_compared("before", before, truth),
            **_compared("after", after, truth),
        }


def _compared(when: str, given: Mapping[str, Any] | None, truth: float) -> dict[str, object]:
    if given is None:
        return {when: np.nan, f"{when}_off": np.nan, f"{when}_covered": False}
    return {
        when: given["value"],
        f"{when}_off": given["value"] / truth - 1.0,
        f"{when}_covered": given["low"] <= truth <= given["high"],
    }
