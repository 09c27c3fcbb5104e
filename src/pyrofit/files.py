"""Where a study's results lie, and how they are written: whole or not at all."""

import contextlib
import gzip
import io
import json
import os
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from pyrofit.errors import DataError


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file under a temporary name, then rename it.

    Raises
    ------
    DataError
        The disk is full or the folder cannot be written; no partial file is left.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
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


def read_json(path: Path) -> dict[str, Any]:
    """Read a JSON file of results.

    Raises
    ------
    DataError
        The file is missing or broken.
    """
    try:
        content = json.loads(path.read_text())
    except FileNotFoundError:
        raise DataError(f"{path}: this result is missing; run the workflow to make it") from None
    except (OSError, ValueError) as error:
        raise DataError(f"{path}: cannot be read ({error}); delete it and run again") from None
    if not isinstance(content, dict):
        raise DataError(f"{path}: this is no result; delete it and run again")
    return content


def write_csv(path: Path, frame: pd.DataFrame) -> None:
    """Write a table, whole or not at all; floats keep every bit; ``.gz`` compresses."""
    buffer = io.StringIO()
    frame.to_csv(buffer, index=False, lineterminator="\n")
    content = buffer.getvalue().encode()
    if path.suffix == ".gz":
        content = gzip.compress(content, compresslevel=4, mtime=0)
    write_bytes(path, content)


def read_csv(path: Path) -> pd.DataFrame:
    """Read a table of results.

    Raises
    ------
    DataError
        The file is missing or broken.
    """
    try:
        return pd.read_csv(path)
    except FileNotFoundError:
        raise DataError(f"{path}: this result is missing; run the workflow to make it") from None
    except (OSError, ValueError, EOFError, zlib.error) as error:
        raise DataError(f"{path}: cannot be read ({error}); delete it and run again") from None


class Results:
    """Paths of a study's results below one folder."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def measurement(self, experiment: str, signal: str) -> Path:
        """Tidy measured series."""
        return self.root / "measurements" / f"{experiment}_{signal}.csv"

    @property
    def measurements_summary(self) -> Path:
        """What was read: sources, checksums, notes, mass closure."""
        return self.root / "measurements" / "summary.json"

    def kinetics(self, name: str) -> Path:
        """Results of the kinetics fit."""
        return self.root / "kinetics" / name

    def repetition(self, cost: str, repetition: int, suffix: str) -> Path:
        """History or result of one repetition."""
        return self.root / "imp" / cost / f"{repetition:02d}{suffix}"

    def least_squares(self, cost: str) -> Path:
        """Multistart least squares on one cost."""
        return self.root / "imp" / cost / "least_squares.json"

    def descent(self, cost: str) -> Path:
        """Least squares from SCE-UA's best set on one cost."""
        return self.root / "imp" / cost / "descent.json"

    def imp(self, name: str) -> Path:
        """Results over all repetitions."""
        return self.root / "imp" / name

    def validation(self, name: str) -> Path:
        """Predictions and scores."""
        return self.root / "validation" / name
