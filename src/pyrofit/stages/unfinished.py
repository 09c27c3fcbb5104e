"""Repetitions of a job that has not ended: Snakemake removes results of jobs that fail.

A job of many repetitions searches some of them side by side, then the next ones. Finished ones wait
here until all are, and then go to their place at once. The same job, started again, finds them.
"""

import contextlib
import hashlib
import shutil
from collections.abc import Sequence

from pyrofit.config import Study, digest
from pyrofit.errors import DataError
from pyrofit.provenance import source_fingerprint
from pyrofit.results import dependencies
from pyrofit.results.files import Results

SUFFIXES = (".csv.gz", "_convergence.csv", ".json")
"""Files of a repetition, in the order in which they are written."""
FOLDER = "unfinished"


class Unfinished:
    """Finished repetitions of jobs on one cost function that have not ended."""

    def __init__(self, study: Study, results: Results, cost: str) -> None:
        """Open those that are of the same study, measurements, kinetics and source."""
        self._final, self._cost = results, cost
        self.results = Results(results.root / FOLDER / _key(study, results, cost))

    def has(self, repetition: int) -> bool:
        """Tell whether a repetition is finished."""
        return self.results.repetition(self._cost, repetition, SUFFIXES[-1]).exists()

    def place(self, repetitions: Sequence[int]) -> None:
        """Move repetitions to where the study has them.

        Raises
        ------
        DataError
            The folder cannot be written.
        """
        for repetition in repetitions:
            for suffix in SUFFIXES:
                path = self._final.repetition(self._cost, repetition, suffix)
                try:
                    path.parent.mkdir(parents=True, exist_ok=True)
                    self.results.repetition(self._cost, repetition, suffix).replace(path)
                except OSError as error:
                    raise DataError(
                        f"{path}: cannot be written ({error.strerror}); make the folder writable. "
                        "Everything finished before is kept."
                    ) from None
        empty = self.results.imp(self._cost)
        with contextlib.suppress(OSError):  # another job of this cost has files there
            for folder in (empty, *list(empty.parents)[:3]):
                folder.rmdir()


def sweep(results: Results) -> None:
    """Delete the remains of studies that were changed before their jobs ended."""
    shutil.rmtree(results.root / FOLDER, ignore_errors=True)


def _key(study: Study, results: Results, cost: str) -> str:
    """Return a digest of all that the repetitions of a cost function are made of."""
    files = [
        results.measurement(name, signal)
        for name, experiment in study.experiments.items()
        for signal in experiment.signals
    ]
    if study.imp.kinetics == "fitted":
        files.append(results.identification("estimate.csv", "kinetics"))
    content = {
        "study": dependencies.imp(study, cost, "sceua"),
        "source": source_fingerprint("pyrofit.stages.fit"),
        "files": [hashlib.sha256(path.read_bytes()).hexdigest() for path in files],
    }
    return digest(content)
