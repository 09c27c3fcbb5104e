"""Result of the diagnosis: written and read as `diagnosis_schema` describes it."""

import json
from collections.abc import Mapping
from typing import Any

import pandas as pd
from pydantic import ValidationError

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.results.diagnosis_schema import Diagnosis
from pyrofit.results.files import Results, read_csv, read_json, write_json

_AGAIN = "delete it and run again"
_WRONG = {
    "missing": "is missing in this result",
    "float_type": "is not a finite number",
    "finite_number": "is not a finite number",
    "int_type": "is not a whole number",
    "string_type": "is not text",
    "bool_type": "is not true or false",
    "list_type": "is not a list",
    "dict_type": "is not a mapping",
    "model_type": "is not a mapping",
    "extra_forbidden": "is not a key of this result",
}


def write(results: Results, content: Mapping[str, Any]) -> None:
    """Write the results; they must agree with the schema."""
    Diagnosis.model_validate_json(json.dumps(content, allow_nan=False))
    write_json(results.diagnosis("diagnosis.json"), content)


def read(study: Study, results: Results) -> dict[str, Any]:
    """Return the result of the diagnosis.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    path = results.diagnosis("diagnosis.json")
    found = read_json(path)
    try:
        Diagnosis.model_validate(found)
    except ValidationError as error:
        raise DataError(f"{path}: {_said(error, found)}; {_AGAIN}") from None
    kind = found["verdict"]["kind"]
    if kind in ("named", "ambiguous", "multiple", "partly") and not found["verdict"]["sets"]:
        raise DataError(f"{path}: 'verdict.sets' is empty; {_AGAIN}")
    here = {(c["experiment"], c["signal"]) for c in found["noise"] + found["windows"]}
    there = {(name, s) for name, e in study.experiments.items() for s in e.signals}
    if found["study"] != study.name or not here <= there:
        raise DataError(f"{path}: this is the diagnosis of another study; {_AGAIN}")
    return found


def _said(error: ValidationError, found: Mapping[str, Any]) -> str:
    """Return the first error in words."""
    first = error.errors()[0]
    if first["type"] == "literal_error":
        return f"unknown verdict '{found['verdict']['kind']}'"
    place = ".".join(str(part) for part in first["loc"])
    return f"'{place}' {_WRONG.get(first['type'], first['msg'])}"


def curves(study: Study, results: Results) -> pd.DataFrame:
    """Return measured curves, those of the base and those with the named effects, SI units."""
    channels = [(c["experiment"], c["signal"]) for c in read(study, results)["noise"]]
    numbers = ("time_s", "measured", "sd", "before")
    return read_csv(
        results.diagnosis("curves.csv"),
        {**dict.fromkeys(numbers, float), **dict.fromkeys(("temperature_K", "after"), object)},
        {("experiment", "signal"): channels},
    )
