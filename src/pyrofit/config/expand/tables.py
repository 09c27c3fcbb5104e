"""Boundary conditions over time from files in a study's folder, read before it is checked."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pyrofit.data.time_table import read_time_table
from pyrofit.errors import DataError, suggest

KINDS = {
    "flux_W_m2": "heat flux",
    "h_W_m2K": "heat transfer coefficient",
    "gas_temperature_K": "temperature",
    "wall_temperature_K": "temperature",
}
"""Kind of unit by key of a side."""
KEYS = "file", "columns", "units"


def with_tables(given: Mapping[str, Any], folder: Path) -> Mapping[str, Any]:
    """Return a study's keys with the points of every ``{file: ...}`` of a side in its place.

    Raises
    ------
    ValueError
        With place, rule and way out, if a file cannot be read as a table over time.
    """
    experiments = given.get("experiments")
    if not isinstance(experiments, Mapping):
        return given
    return {**given, "experiments": {n: _experiment(n, e, folder) for n, e in experiments.items()}}


def _experiment(name: str, given: Any, folder: Path) -> Any:
    if not isinstance(given, Mapping):
        return given
    sides = {
        side: {
            key: _table(f"experiments.{name}.{side}.{key}", KINDS[key], value, folder)
            if key in KINDS and isinstance(value, Mapping) and "file" in value
            else value
            for key, value in given[side].items()
        }
        for side in ("front", "back")
        if isinstance(given.get(side), Mapping)
    }
    return {**given, **sides} if sides else given


def _table(place: str, kind: str, given: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    for key in given:
        if key not in KEYS:
            raise ValueError(f"{place}: unknown key '{key}'. {suggest(str(key), KEYS)}")
    path = folder / str(given["file"])
    try:
        time, value = read_time_table(
            path, kind, given.get("columns") or {}, given.get("units") or {}
        )
    except DataError as error:
        raise ValueError(f"{place}: {error}") from None
    return {"time_s": time.tolist(), "value": value.tolist()}
