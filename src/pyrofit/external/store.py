"""Records of all runs, so that none is made twice: the curves, or the reason of a failure.

A run is known by the digest of all that it depends on. Its file is written once and whole. If two
processes run the same set, both use the file of the first.
"""

import contextlib
import gzip
import json
import os
import shutil
import uuid
import zlib
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pyrofit.errors import ProgramError
from pyrofit.external.output import WrittenCurve

Content = dict[str, Any]
PART = ".part"
"""Suffix of files that are being written; the next run deletes those of killed processes."""


class StoredRun(NamedTuple):
    """The record of a run that succeeded.

    Parameters
    ----------
    records
        Its curves by signal.
    seconds
        Its wall time [s].
    version
        Version that the program prints, if it does.
    """

    records: Mapping[str, WrittenCurve]
    seconds: float
    version: str = ""


class Store:
    """The folder of one experiment; without a folder nothing is kept.

    Parameters
    ----------
    folder
        ``results/<study>/programs/<experiment>``; empty = none.
    """

    def __init__(self, folder: str) -> None:
        self.folder = Path(folder) if folder else None

    def known(self, key: str) -> StoredRun | None:
        """Return the record of a run that succeeded; None if there is none."""
        content = _read(self._run(key), gzip.decompress)
        if content is None:
            return None
        records = {
            name: WrittenCurve(np.array(one["at"]), np.array(one["value"]))
            for name, one in content["signals"].items()
        }
        return StoredRun(records, content["seconds"], content["version"])

    def keep(self, key: str, run: StoredRun) -> None:
        """Keep the curves of a run."""
        path = self._run(key)
        if path is None:
            return
        is_damaged = path.exists() and self.known(key) is None
        content = {
            "seconds": run.seconds,
            "version": run.version,
            "signals": {
                name: {"at": one.at.tolist(), "value": one.value.tolist()}
                for name, one in run.records.items()
            },
        }
        _write(path, gzip.compress(json.dumps(content).encode(), 6, mtime=0), is_damaged)
        failed = self._failed(key)
        if failed is not None:  # of an earlier attempt
            failed.unlink(missing_ok=True)

    def failure(self, key: str) -> Content | None:
        """Return the record of a run that failed; None if there is none."""
        return _read(self._failed(key), bytes)

    def fail(self, key: str, content: Content, run: Path | None, most: int) -> None:
        """Record a failure; keep the folder of the run if fewer than ``most`` are kept."""
        path = self._failed(key)
        if path is None:
            return
        kept = _kept(run, path.with_suffix(""), most) if run is not None else None
        text = json.dumps({**content, "folder": kept}, indent=1, ensure_ascii=False)
        _write(path, text.encode("utf-8", "surrogateescape") + b"\n", replace=True)

    def counts(self) -> tuple[int, Counter[str]]:
        """Return the number of runs that succeeded, and that of failures by reason."""
        if self.folder is None:
            return 0, Counter()
        runs = sum(1 for _ in self.folder.glob("runs/*/*.json.gz"))
        records = [_read(path, bytes) for path in self.folder.glob("failed/*.json")]
        return runs, Counter(record["why"] for record in records if record)

    def _run(self, key: str) -> Path | None:
        return self.folder and self.folder / "runs" / key[:2] / f"{key}.json.gz"

    def _failed(self, key: str) -> Path | None:
        return self.folder and self.folder / "failed" / f"{key}.json"


def _read(path: Path | None, unpack: Callable[[bytes], bytes]) -> Content | None:
    """Return the content of a file; None if it is missing or damaged."""
    try:
        found = json.loads(unpack(path.read_bytes())) if path else None
    except (OSError, EOFError, ValueError, zlib.error):
        return None
    return found if isinstance(found, dict) else None


def _kept(run: Path, to: Path, most: int) -> str | None:
    """Copy the folder of a run beside its record; return its name, None if enough are kept."""
    for number in range(most):
        # Only one process can make a place, and it holds one folder. A full disk keeps none.
        with contextlib.suppress(OSError):
            to.parent.mkdir(parents=True, exist_ok=True)
            (to.parent / f".place_{number}").touch(exist_ok=False)
            shutil.copytree(run, to, dirs_exist_ok=True, symlinks=True)
            return to.name
    return None


def _write(path: Path, content: bytes, replace: bool) -> None:
    """Write a file whole; an existing one stays, unless it is to be replaced.

    Raises
    ------
    ProgramError
        The disk is full, or the folder cannot be written.
    """
    written = path.with_name(f".{uuid.uuid4().hex}{PART}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            written.write_bytes(content)
            _name(written, path, replace)
        finally:
            written.unlink(missing_ok=True)
    except OSError as error:
        raise ProgramError(
            f"{path}: cannot be written ({error.strerror}); make room, and run again to go on"
        ) from None


def _name(written: Path, path: Path, replace: bool) -> None:
    """Give a written file its name."""
    if not replace:
        try:
            os.link(written, path)
        except FileExistsError:
            return
        except OSError:  # a file system without links
            pass
        else:
            return
    os.replace(written, path)
