"""What each step of a run depends on, in files that are inputs of the rules."""

import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from pyrofit.config import Study, digest, read_study
from pyrofit.provenance import source_fingerprint
from pyrofit.results.dependencies import Slice
from pyrofit.results.files import write_text
from pyrofit.running.lock import RunError, job

FOLDER = "inputs"
STUDY_OF_RUN = "PYROFIT_STUDY"
"""Environment variable that passes the study file of a run to its jobs."""


class InputFiles:
    """The inputs of all steps of a study, a file each, written when its content changes.

    Snakemake compares a file with that which it made the results from: an edit that is taken back
    runs nothing again. So the study is not in it, as parts that a step does not use would count. It
    names the file of the study, which only the start of a run writes.

    Parameters
    ----------
    study, root
        The study as checked and completed, and its results folder.
    as_they_are
        Whether to write nothing, as a job of a cluster must.
    """

    def __init__(self, study: Study, root: Path, as_they_are: bool = False) -> None:
        self._study = study
        self._root = root
        self._as_they_are = as_they_are
        self._planned: dict[Path, str] = {}
        self._fingerprint = cache(source_fingerprint)
        self._told = False

    def __call__(
        self, step: str, slice_of: Callable[..., Slice], *modules: str, of: Sequence[str] = ()
    ) -> Path:
        """Plan a step, and return the file of its inputs.

        Parameters
        ----------
        step
            Name of the step, or of a part of it.
        slice_of, of
            Function of the study, and of further arguments. It returns all that the results depend
            on but code, and files that are inputs of the rule themselves.
        modules
            Full names of the modules that compute it.

        Raises
        ------
        DataError
            The file cannot be written.
        """
        path = self._root / FOLDER / f"{step}.json"
        if not self._as_they_are and path not in self._planned:
            self._planned[path] = _text(
                {
                    "study": str(self._file),
                    "digest": digest(slice_of(self._study, *of)),
                    "source": self._fingerprint(*modules),
                }
            )
            self._write(path)
        return path

    def begin(self) -> None:
        """Write the study for the jobs of a run, which has the lock of the results folder.

        Raises
        ------
        RunError
            Another process has planned another study since.
        DataError
            The file cannot be written.
        """
        for path, text in self._planned.items():
            if not _holds(path, text):
                raise RunError(f"{path}: changed while this run was planned; start it again")
        text = _text(self._study.model_dump(mode="json"))
        if not _holds(self._file, text):
            write_text(self._file, text)
        os.environ[STUDY_OF_RUN] = str(self._file)

    @property
    def _file(self) -> Path:
        return self._root / "study.json"

    def _write(self, path: Path) -> None:
        """Write a file of inputs, unless a run is alive: its results are made of those it has."""
        if not path.exists():
            write_text(path, self._planned[path])
        elif not _holds(path, self._planned[path]):
            try:
                with job(self._root, by_hand=True):
                    write_text(path, self._planned[path])
            except RunError:
                if not self._told:
                    text = "a run of this study is alive; steps are planned as it knows them"
                    print(f"{self._root}: {text}", file=sys.stderr)
                self._told = True


def study_of_run(given: Mapping[str, Any]) -> Study:
    """Return the study that the run of this job of a cluster was started with.

    Of the study as its file now says, the name counts, and only if no variable reached the job.

    Raises
    ------
    StudyError
        There is no such study.
    """
    file = Path("results") / str(given.get("name")) / "study.json"
    return read_study(Path(os.environ.get(STUDY_OF_RUN, file)))


def named_study(file: Path) -> Path | None:
    """Return the study file that a file of inputs names; none if it is no such file."""
    if file.parent.name != FOLDER or file.suffix != ".json":
        return None
    try:
        return Path(json.loads(file.read_bytes())["study"])
    except (OSError, ValueError, LookupError, TypeError):
        return None


def _text(content: Mapping[str, Any]) -> str:
    return json.dumps(content, indent=1) + "\n"


def _holds(path: Path, text: str) -> bool:
    return path.exists() and path.read_bytes() == text.encode()
