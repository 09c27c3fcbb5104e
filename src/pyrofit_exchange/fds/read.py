"""Output of a run of FDS: ``_devc.csv`` and ``_tga.csv``."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.numerics import linear
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.solver.outputs import MASS_FRACTION
from pyrofit_exchange.fds.records import DEVICES
from pyrofit_exchange.fds.versions import FdsError

COLUMNS = {
    "MLR": "rate_kg_m2s",
    "T_back": "back_K",
    "T_front": "front_K",
    "mass": "mass_kg_m2",
}
"""pyrofit's names of the records of a deck, without its thickness."""


def _table(path: Path) -> pd.DataFrame:
    """Return a table of FDS: units in the first row, names in the second.

    Raises
    ------
    FdsError
        The file is missing, empty or cut.
    """
    try:
        frame = pd.read_csv(path, skiprows=1, skipinitialspace=True)
    except FileNotFoundError:
        raise FdsError(f"{path.name}: FDS has not written it") from None
    except (OSError, ValueError) as error:
        raise FdsError(f"{path.name}: cannot be read ({error})") from None
    frame.columns = [str(name).strip() for name in frame.columns]
    numbers = frame.apply(pd.to_numeric, errors="coerce")
    if numbers.empty or numbers.iloc[:-1].isna().to_numpy().any():
        raise FdsError(f"{path.name}: it holds no numbers, or gaps")
    whole: pd.DataFrame = numbers.dropna()  # without the last row of a run that was cut
    return whole


def read_devc(path: Path, weights: Sequence[float] = (1.0,)) -> pd.DataFrame:
    """Return the curves of a slab, SI units; time is the middle of the interval of each mean.

    Parameters
    ----------
    path
        ``<run>_devc.csv``.
    weights
        Weights of the spots of the surface.

    Raises
    ------
    FdsError
        The file is missing or cut, or lacks a column.
    """
    raw = _table(path)
    names = [name for name in DEVICES if name in COLUMNS]
    found = {}
    for name in names:
        own = [name] if len(weights) == 1 else [f"{name}_{n + 1}" for n in range(len(weights))]
        for column in ("Time", *own):
            if column not in raw:
                raise FdsError(f"{path.name}: the column '{column}' is missing")
        found[COLUMNS[name]] = linear.product(raw[own].to_numpy(float), np.asarray(weights))
    time = raw["Time"].to_numpy(float)
    before = np.concatenate([[time[0]], time[:-1]])
    frame = pd.DataFrame({"time_s": 0.5 * (time + before), "end_s": time, **found}).iloc[1:]
    kelvin = ["back_K", "front_K"]
    frame[kelvin] += ICE_POINT_K
    return frame.reset_index(drop=True)


def read_tga(path: Path) -> pd.DataFrame:
    """Return temperature of the sample [K] and mass fraction of a TGA.

    From 6.8 on ``Temp`` is the furnace and ``T_surf`` the sample; before, ``Temp`` is the sample.

    Raises
    ------
    FdsError
        The file is missing or cut, or lacks a column.
    """
    raw = _table(path)
    named = {name.casefold(): name for name in raw.columns}
    temperature = named.get("t_surf", named.get("temp"))
    mass = next((named[n] for n in ("total mass", "mass", "total_mass") if n in named), None)
    if temperature is None or mass is None:
        raise FdsError(f"{path.name}: the columns 'Temp' and 'Total mass' are missing")
    left = raw[mass].to_numpy(float)
    T = raw[temperature].to_numpy(float) + ICE_POINT_K
    falls = np.flatnonzero(np.diff(T) <= 0.0)  # FDS's temperature of a sample that is gone
    end = int(falls[0]) + 1 if falls.size else len(T)
    return pd.DataFrame({"temperature_K": T[:end], MASS_FRACTION: left[:end] / left[0]})
