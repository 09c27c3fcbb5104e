"""Fits as JSON: every number with all its bits, and a version that a reader can tell."""

import json
import math
import os
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from pydantic import TypeAdapter

from pyrofit.api.arguments import path_of
from pyrofit.api.choices import Key
from pyrofit.api.comparison import Comparison
from pyrofit.config import as_study
from pyrofit.errors import DataError
from pyrofit.results.files import write_text
from pyrofit.results.goodness import Goodness

FORMAT = "pyrofit fit"
VERSION = 1
"""Raised where an older reader would misread the file."""
_NUMBERS = "chi2", "freedom", "cost"
_TABLES = "table", "signals", "correlation", "history", "derived"
_CURVES = "measured", "simulated"
_GOODNESS = TypeAdapter(Goodness)


def as_json(fit: Any, path: str | os.PathLike[str] | None) -> str:
    """Return a fit as JSON, and write it to a file where one is named.

    Raises
    ------
    DataError
        The file cannot be written.
    """
    content = {
        "format": FORMAT,
        "version": VERSION,
        "study": fit.study.model_dump(mode="json"),
        "method": fit.method,
        "values": fit.values,
        **{name: _number(getattr(fit, name)) for name in _NUMBERS},
        **{name: _table(getattr(fit, name)) for name in _TABLES},
        **{kind: _series(getattr(fit.comparison, kind)) for kind in _CURVES},
        "goodness": None if fit.goodness is None else asdict(fit.goodness),
        "verdict": list(fit.verdict),
        "weights": [[*key, weight.tolist()] for key, weight in fit.weights.items()],
    }
    text = json.dumps(content, indent=1, allow_nan=False) + "\n"
    if path is not None:
        write_text(path_of("path", path), text)
    return text


def fields_of(source: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the fields of a fit from its JSON or the path of a file.

    Raises
    ------
    DataError
        The file is missing, is no fit, is of a later version, or lacks a part.
    StudyError
        Its study breaks a rule of this version.
    """
    text, label = _text(source)
    try:
        content = json.loads(text)
    except ValueError:
        content = None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise DataError(f"{label}: this is no fit; give the text or file of `fit.to_json`")
    if content.get("version") != VERSION:
        raise DataError(
            f"{label}: this fit has the version {content.get('version')}, and this pyrofit reads "
            f"version {VERSION}; read it with the pyrofit that wrote it"
        )
    try:
        study = as_study(content["study"], f"{label}, study", located=True)
        curves = [_series_of(content[kind]) for kind in _CURVES]
        return {
            "study": study,
            "method": str(content["method"]),
            "values": {name: float(value) for name, value in content["values"].items()},
            "comparison": Comparison(study, *curves),
            **{name: float(content[name]) for name in _NUMBERS},
            **{name: _table_of(content[name]) for name in _TABLES},
            "goodness": _GOODNESS.validate_python(content["goodness"])
            if content["goodness"]
            else None,
            "verdict": tuple(content["verdict"]),
            "weights": {(e, s): np.array(weight) for e, s, weight in content["weights"]},
        }
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        said = f"{type(error).__name__}: {error}".splitlines()[0]
        raise DataError(
            f"{label}: a part of the fit is missing or broken ({said}); write it anew"
        ) from None


def _text(source: Any) -> tuple[str, str]:
    """Return the JSON of a source, and what a message calls it."""
    if isinstance(source, str) and source.lstrip().startswith("{"):
        return source, "JSON of a fit"
    if not isinstance(source, str | os.PathLike):
        raise DataError(
            f"from_json: this is a {type(source).__name__}; give the text of `fit.to_json`, or the "
            "path of its file"
        )
    try:
        return Path(source).read_text(encoding="utf-8"), str(source)
    except (OSError, ValueError) as error:
        said = getattr(error, "strerror", None) or error
        raise DataError(f"{source}: cannot be read ({said}); check the path") from None


def _number(value: Any) -> Any:
    """Return a cell as JSON has it; numbers that are not finite as text."""
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else str(float(value))
    return value.item() if isinstance(value, np.generic) else value


def _table(frame: pd.DataFrame | None) -> dict[str, Any] | None:
    if frame is None:
        return None
    counted = isinstance(frame.index, pd.RangeIndex)
    return {
        "index": None if counted else [frame.index.name, frame.index.tolist()],
        "columns": [
            [str(name), str(frame[name].dtype), [_number(cell) for cell in frame[name]]]
            for name in frame.columns
        ],
        "attrs": frame.attrs,
    }


def _table_of(content: dict[str, Any] | None) -> pd.DataFrame | None:
    if content is None:
        return None
    columns = {
        name: pd.Series(list(map(float, cells)) if kind.startswith("float") else cells, dtype=kind)
        for name, kind, cells in content["columns"]
    }
    frame = pd.DataFrame(columns)
    if content["index"] is not None:
        name, values = content["index"]
        frame.index = pd.Index(values, name=name)
    frame.attrs = content["attrs"]
    return frame


def _series(frames: Mapping[Key, pd.DataFrame]) -> list[Any]:
    return [[*key, _table(frame)] for key, frame in frames.items()]


def _series_of(content: list[Any]) -> dict[Key, pd.DataFrame]:
    found = {}
    for experiment, signal, table in content:
        frame = _table_of(table)
        assert frame is not None
        found[experiment, signal] = frame
    return found
