"""Where a study's results lie, and how they are written: whole or not at all."""

import contextlib
import gzip
import io
import json
import uuid
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.errors import DataError
from pyrofit.results.needed import AGAIN, Keys, check_rows, check_value

PART = ".part"
"""Suffix of files that are being written; the next run deletes those of killed processes."""


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file under a temporary name, then rename it.

    Raises
    ------
    DataError
        The disk is full or the folder cannot be written; no partial file is left.
    """
    # The number of a process is not unique on a file system that several machines share.
    temporary = path.with_name(f".{path.name}.{uuid.uuid4().hex[:12]}{PART}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary.write_bytes(content)
        temporary.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise DataError(
            f"{path}: cannot be written ({error.strerror}); make room or choose another folder. "
            "Everything finished before is kept."
        ) from None


def write_text(path: Path, text: str) -> None:
    """Write a text file, whole or not at all."""
    write_bytes(path, text.encode())


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write a JSON file, whole or not at all; floats keep every bit."""
    write_text(path, json.dumps(content, indent=1, allow_nan=False) + "\n")


def read_json(path: Path, needs: Mapping[Keys, type] | None = None) -> dict[str, Any]:
    """Read a JSON file of results.

    Parameters
    ----------
    path
        The file.
    needs
        Required content: the type of each value by the keys that lead to it, such as
        ``{("verdict", "kind"): str}``.

    Raises
    ------
    DataError
        The file is missing or broken, or something is missing in it.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise DataError(f"{path}: this result is missing; run the workflow to make it") from None
    except (OSError, ValueError, RecursionError) as error:
        raise DataError(f"{path}: cannot be read ({error}); {AGAIN}") from None
    if not isinstance(content, dict):
        raise DataError(f"{path}: this is no result; {AGAIN}")
    for keys, kind in (needs or {}).items():
        check_value(path, content, keys, kind)
    return content


def write_csv(path: Path, frame: pd.DataFrame) -> None:
    """Write a table, whole or not at all; floats keep every bit; ``.gz`` compresses."""
    buffer = io.StringIO()
    frame.to_csv(buffer, index=False, lineterminator="\n")
    content = buffer.getvalue().encode()
    if path.suffix == ".gz":
        content = gzip.compress(content, compresslevel=4, mtime=0)
    write_bytes(path, content)


def read_csv(
    path: Path,
    columns: Mapping[str, type] | None = None,
    rows: Mapping[Keys, Iterable[Keys]] | None = None,
) -> pd.DataFrame:
    """Read a table of results.

    Parameters
    ----------
    path
        The file.
    columns
        The columns it must have: float for numbers without gaps, object for anything.
    rows
        Values that must occur, and no others, by columns.

    Raises
    ------
    DataError
        The file is missing or broken, or something is missing in it.
    """
    try:
        # A parameter may be named NA; only an empty cell holds nothing.
        frame = pd.read_csv(path, keep_default_na=False, na_values=[""])
    except FileNotFoundError:
        raise DataError(f"{path}: this result is missing; run the workflow to make it") from None
    except (OSError, ValueError, EOFError, zlib.error) as error:
        raise DataError(f"{path}: cannot be read ({error}); {AGAIN}") from None
    for name, kind in (columns or {}).items():
        if name not in frame or frame.empty:
            raise DataError(f"{path}: the column '{name}' is missing or empty; {AGAIN}")
        column = frame[name]
        finite = pd.api.types.is_numeric_dtype(column) and bool(np.isfinite(column).all())
        if kind is float and not finite:
            raise DataError(
                f"{path}: the column '{name}' does not hold numbers throughout; {AGAIN}"
            )
    for names, wanted in (rows or {}).items():
        check_rows(path, frame, names, list(wanted))
    return frame


class Results:
    """Paths of a study's results below one folder.

    Results of a step run ``by_hand`` with options other than the study's stand apart.
    """

    def __init__(self, root: Path, by_hand: str = "") -> None:
        self.root = root
        self.by_hand = by_hand

    def folder(self, name: str) -> Path:
        """Return a folder of results, such as that of a step."""
        return self.root / "by_hand" / name if name == self.by_hand else self.root / name

    def of_step(self, step: str, name: str) -> Path:
        """Return the path of a file of a step."""
        return self.folder(step) / name

    def measurement(self, experiment: str, signal: str) -> Path:
        """Tidy measured series."""
        return self.root / "measurements" / f"{experiment}_{signal}.csv"

    @property
    def measurements_summary(self) -> Path:
        """Record of the read files: sources, checksums, notes, mass closure."""
        return self.root / "measurements" / "summary.json"

    def kinetics(self, name: str) -> Path:
        """Results of the kinetics fit."""
        return self.root / "kinetics" / name

    def isoconversional(self, name: str) -> Path:
        """Activation energies over conversion, without a model of the reactions."""
        return self.root / "isoconversional" / name

    def repetition(self, cost: str, repetition: int, suffix: str) -> Path:
        """History or result of one repetition."""
        return self.root / "imp" / cost / f"{repetition:02d}{suffix}"

    def starts(self, cost: str, optimiser: str) -> Path:
        """All ends of an optimiser that goes from several starts on one cost."""
        return self.root / "imp" / cost / f"{optimiser}.json"

    def descent(self, cost: str) -> Path:
        """Least squares from SCE-UA's best set on one cost."""
        return self.root / "imp" / cost / "descent.json"

    def imp(self, name: str) -> Path:
        """Results over all repetitions."""
        return self.root / "imp" / name

    def identification(self, name: str, stage: str = "imp") -> Path:
        """Intervals of a stage's parameters, 'kinetics' or 'imp', and all that they rest on."""
        return self.root / "identification" / stage / name

    def comparison(self, name: str) -> Path:
        """All sets of all optimisers under all costs, and the family of good ones."""
        return self.root / "comparison" / name

    def validation(self, name: str) -> Path:
        """Predictions and scores."""
        return self.root / "validation" / name

    def diagnosis(self, name: str) -> Path:
        """Disagreement of model and measurement, and missing effects."""
        return self.root / "diagnosis" / name

    def programs(self, name: str) -> Path:
        """Files of external programs: their runs, and the timed one."""
        return self.root / "programs" / name

    def fds(self, name: str) -> Path:
        """Files for FDS, and its results."""
        return self.root / "fds" / name
