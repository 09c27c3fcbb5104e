"""The result of a check, and the situation that is checked."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from pyrofit.config import Study

Level = Literal["ok", "warning", "error"]


@dataclass(frozen=True)
class ReadyLine:
    """One line of the report.

    Parameters
    ----------
    level
        'error': the run would fail or lose hours; 'warning': it can work.
    subject
        Subject of the check, one word.
    text
        The finding; of a warning or an error with the remedy.
    """

    level: Level
    subject: str
    text: str

    def __str__(self) -> str:
        """Return the line.

        >>> str(ReadyLine("ok", "disk", "9 GB free"))
        'ok       disk      9 GB free'
        """
        return f"{self.level:<8} {self.subject:<9} {self.text}"


@dataclass(frozen=True)
class Situation:
    """The run that is planned.

    Parameters
    ----------
    study
        The study; None checks the machine alone.
    results
        Folder of the results; it need not exist.
    cores
        Number of jobs that run at once.
    project
        Folder with the Snakefile and requirements.lock.
    profile
        Keys of the Snakemake profile.
    """

    study: Study | None
    results: Path
    cores: int
    project: Path = Path()
    profile: Mapping[str, Any] = field(default_factory=dict)

    @property
    def job_cores(self) -> int | None:
        """Cores of this machine that run jobs; None where a cluster does."""
        return None if self.on_slurm else self.cores

    @property
    def on_slurm(self) -> bool:
        """Whether the jobs run on a Slurm cluster."""
        return self.profile.get("executor") == "slurm"


Check = Callable[[Situation], Iterator[ReadyLine]]


def writable(folder: Path) -> str:
    """Make a folder and try to write a file in it; return the reason of a failure, or ""."""
    import tempfile

    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(b"0")
    except OSError as error:
        return error.strerror or str(error)
    return ""


def size(count: float) -> str:
    """Return a number of bytes in words.

    >>> size(2.34e9), size(4.2e6)
    ('2.3 GB', '4 MB')
    """
    return f"{count / 1e9:.1f} GB" if count >= 1e9 else f"{count / 1e6:.0f} MB"
