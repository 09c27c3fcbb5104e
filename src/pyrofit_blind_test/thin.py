"""Make the files of `pyrofit_blind_test.foreign` from curves of another code in full."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.errors import DataError
from pyrofit.results.files import read_csv, read_json, write_csv, write_json
from pyrofit.results.needed import Keys
from pyrofit.solver.arrays import FloatArray
from pyrofit_blind_test.foreign import EXPERIMENT, MANIFEST, Manifest, Truth

SPACING_S = 5.0
"""Distance of the points kept [s]."""
KEPT = {
    "mlr_kg_m2s": ("mlr_kg_m2_s", 5.0, "%.5g"),
    "T_back_K": ("back_temperature_K", 1.0, "%.2f"),
}
"""Column, width of the mean [s] and digits kept, by column of the originals."""
_NEEDS: dict[Keys, type] = {("cases",): dict}


def thin(source: Path, target: Path) -> list[Path]:
    """Write manifest and thinned curves of all cases; return the files.

    Raises
    ------
    DataError
        A file of the originals is missing or broken, or a file cannot be written.
    """
    given = read_json(source / MANIFEST, _NEEDS)
    written = []
    truths = {}
    for name, case in given["cases"].items():
        parts = [_curves(source, name, flux) for flux in case["experiments"]]
        path = target / f"{name}.csv"
        write_csv(path, pd.concat(parts, ignore_index=True))
        truths[name] = Truth(
            values=case["base_values_SI"],
            effects=case["effects"],
            other_form=case.get("other_form", False),
        )
        written.append(path)
    manifest = Manifest(code=_code(source, given), cases=truths)
    write_json(target / MANIFEST, manifest.model_dump(mode="json"))
    return [*written, target / MANIFEST]


def _code(source: Path, given: Mapping[str, object]) -> str:
    """Return name and version of the code."""
    if "code" in given:
        return str(given["code"])
    if "fds_version" in given:
        return f"FDS {given['fds_version']}"
    raise DataError(f"{source / MANIFEST}: lacks `code`; give the name and version of the code")


def _curves(source: Path, case: str, flux: str) -> pd.DataFrame:
    path = source / f"{case}_{flux}.csv"
    frame = read_csv(path, dict.fromkeys(("time_s", *KEPT), float))
    time = frame["time_s"].to_numpy(float)
    if time.size < 2 or time[-1] < SPACING_S:
        raise DataError(f"{path}: ends before {SPACING_S:g} s; give the whole curve")
    end = 1.5 * time[-1] - 0.5 * time[-2]
    last = np.floor(end / SPACING_S) * SPACING_S
    middles = np.arange(0.5 * SPACING_S, last, SPACING_S)
    columns: dict[str, object] = {EXPERIMENT: f"slab_{flux}", "time_s": middles}
    for name, (column, width, digits) in KEPT.items():
        means = bin_means(time, frame[name].to_numpy(float), middles, width)
        columns[column] = [float(digits % mean) for mean in means]
    return pd.DataFrame(columns)


def bin_means(
    time: FloatArray, values: FloatArray, middles: FloatArray, width: float
) -> FloatArray:
    """Return means of a series of bin means over other bins.

    m = (I(t + w/2) - I(t - w/2)) / w, I the integral of the series; a value holds between the
    middles of its time and its neighbours' times.

    Parameters
    ----------
    time, values
        Middle [s] and mean of each given bin, shape (n,).
    middles
        Middle of each wanted bin [s], shape (m,).
    width
        Width w of the wanted bins [s].

    Examples
    --------
    >>> time, values = np.array([0.5, 1.5, 2.5, 3.5]), np.array([1.0, 3.0, 5.0, 7.0])
    >>> bin_means(time, values, np.array([1.0, 3.0]), 2.0).tolist()
    [2.0, 6.0]
    """
    inner = 0.5 * (time[1:] + time[:-1])
    edges = np.concatenate([[2.0 * time[0] - inner[0]], inner, [2.0 * time[-1] - inner[-1]]])
    integral = np.concatenate([[0.0], np.cumsum(values * np.diff(edges))])
    ends = (np.interp(middles + sign * 0.5 * width, edges, integral) for sign in (1.0, -1.0))
    above, below = ends
    return np.asarray((above - below) / width)
