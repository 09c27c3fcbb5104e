"""Finished descents of a diagnosis, kept for the case that it is broken off.

A descent is named by all that it is made of, so that the same one, wanted again, has the same bits.
The model is in that name by its whitened residuals at the start and at a second point. In these
the measurements, their noise and all settings of the model have their part.

Derivatives take megabytes. Those that were made at the end of a descent are made there again, with
the same bits; only updated ones are kept.
"""

import hashlib
import io
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from pyrofit.estimate.bounded_least_squares import Fit
from pyrofit.results.files import write_bytes
from pyrofit.solver.arrays import FloatArray

WORTH_S = 0.3
"""Least time of a descent that is kept [s]; a shorter one is as soon made anew."""
INWARDS = 0.1
"""Part of the way from the start to the centre of the limits at which the second point lies."""
SUFFIX = ".npz"
OF_FRESH = ("x", "returned")
"""Fields that are kept of a descent that ends with derivatives made there."""
OF_ANY = ("chi2", "x", "residuals", "jacobian", "fresh", "returned")
"""Those of any other descent, in the order of a fit."""


@dataclass(frozen=True)
class Journal:
    """Descents that are kept in a folder, which belongs to one study, its data and this source."""

    folder: Path
    worth_s: float = WORTH_S

    def __len__(self) -> int:
        """Return the number of descents that are kept."""
        return sum(1 for _ in self.folder.glob(f"*{SUFFIX}"))

    def fit(
        self, name: str, descend: Callable[[], Fit], at_end: Callable[[FloatArray], Fit]
    ) -> Fit:
        """Return the descent of this name, which is made if it is not there.

        Parameters
        ----------
        name
            As `name_of_descent` gives it.
        descend
            Makes the descent.
        at_end
            From the x of its end to the fit there, with derivatives made there.

        Raises
        ------
        DataError
            The folder cannot be written.
        """
        path = self.folder / f"{name}{SUFFIX}"
        found = _read(path, at_end)
        if found is None:
            began = time.perf_counter()
            found = descend()
            if time.perf_counter() - began >= self.worth_s:
                write_bytes(path, _written(found))
        return found


def name_of_descent(
    residuals: Callable[[FloatArray], list[FloatArray]], x: FloatArray, *others: object
) -> str:
    """Return a name of the descent from x.

    Parameters
    ----------
    residuals
        Whitened residuals of several sets, shape (sets, parameters).
    x
        Start, shape (parameters,).
    others
        All else that the descent depends on: arrays, fits, and what `repr` tells in full.
    """
    at = np.clip(x, 0.0, 1.0)
    second = at + INWARDS * (0.5 - at)
    made_of = hashlib.sha256()
    for part in (x, *residuals(np.array([at, second])), *others):
        made_of.update(_content(part) + b"\n")
    return made_of.hexdigest()[:32]


def _content(part: object) -> bytes:
    if isinstance(part, np.ndarray):
        return f"{part.dtype} {part.shape}".encode() + part.tobytes()
    if isinstance(part, Fit):
        return b"".join(_content(getattr(part, name)) for name in OF_ANY)
    return repr(part).encode()


def _written(fit: Fit) -> bytes:
    buffer = io.BytesIO()
    names = OF_FRESH if fit.fresh else OF_ANY
    values: dict[str, Any] = {name: np.asarray(getattr(fit, name)) for name in names}
    np.savez(buffer, **values)
    return buffer.getvalue()


def _read(path: Path, at_end: Callable[[FloatArray], Fit]) -> Fit | None:
    """Return a kept descent; None where there is none, or a broken one."""
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as kept:
            values = {name: kept[name] for name in kept.files}
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None
    if set(values) == set(OF_FRESH):
        return replace(at_end(values["x"]), returned=values["returned"].item())
    if set(values) != set(OF_ANY):
        return None
    return Fit(*(v if v.ndim else v.item() for v in (values[name] for name in OF_ANY)))
