"""Printed output, kept in a log file as well."""

from collections.abc import Callable
from pathlib import Path
from typing import IO

Tell = Callable[[str], None]
"""Receives messages on the progress of a step."""


class Tee:
    """Standard error that is written to a log file as well, as long as there is room for it."""

    def __init__(self, usual: IO[str], log: IO[str]) -> None:
        self._usual = usual
        self._log: IO[str] | None = log

    def write(self, text: str) -> int:
        """Write to both."""
        self._usual.write(text)
        self.log(text)
        return len(text)

    def log(self, text: str) -> bool:
        """Write to the log alone; return whether that was possible."""
        if self._log is not None:
            try:
                self._log.write(text)
                self._log.flush()
            except OSError as error:
                # The results are worth more than their log: go on.
                self._usual.write(f"{self._log.name}: log cut off here ({error.strerror})\n")
                self._log = None
        return self._log is not None

    def flush(self) -> None:
        """Flush standard error; the log is never behind."""
        self._usual.flush()

    def isatty(self) -> bool:
        """Say that this is no terminal."""
        return False


def open_log(path: Path) -> IO[str]:
    """Open a log; a disk that is full says so before anything is computed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"\n")
    return path.open("w", encoding="utf-8")
