"""The timed runs of external programs before a campaign."""

from pyrofit.results.files import Results
from pyrofit.results.record import Record, read_record


class TimedRun(Record):
    """A program, its version and files with their checksums, and the time of one run [s]."""

    command: list[str]
    executable: str
    sha256: str
    version: str
    files: dict[str, str]
    seconds: float
    time_limit_s: float


class Trial(Record):
    """The content of ``programs/trial.json``: runs by experiment, planned calls by search."""

    experiments: dict[str, TimedRun]
    calls: dict[str, int]
    core_hours: float


def timed_runs(results: Results) -> dict[str, TimedRun]:
    """Return the timed runs by experiment.

    Raises
    ------
    DataError
        Their record is missing or broken.
    """
    return read_record(results.programs("trial.json"), Trial).experiments
