"""Measured files as they are understood, before there is a study."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pyrofit.errors import DataError
from pyrofit.show import style
from pyrofit.show.text import several
from pyrofit_files import look_picture as picture
from pyrofit_files.looked import Looked, look_at

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class Look:
    """Measured files as they are understood; print it, or plot it.

    Parameters
    ----------
    looked
        The files, and the tests that they are taken for.
    """

    looked: Looked

    @property
    def lines(self) -> list[str]:
        """What was understood of each file, its faults, and repeats that disagree."""
        return list(self.looked.lines())

    def __str__(self) -> str:
        """Return the lines as one text."""
        return "\n".join(self.lines)

    def __repr__(self) -> str:
        """Return how many files and tests there are; print it for what they are taken for."""
        files, tests = len(self.looked.files), len(self.looked.tests)
        return f"{several(files, 'file')}, {several(tests, 'record')}; print it to see them"

    def plot(self) -> "Figure":
        """Return a figure with a panel for each quantity of each test.

        Raises
        ------
        DataError
            Nothing is recognised in the files.
        """
        with style.style():
            return picture.draw_look(self.looked)

    def write(self, path: str | Path) -> None:
        """Write the figure as PNG or SVG, or as HTML with the lines.

        Raises
        ------
        DataError
            The name has another ending, or the file cannot be written.
        """
        picture.write(self.looked, Path(path))


def look(files: str | Path | Sequence[str | Path]) -> Look:
    """Return measured files as they are understood: quantity, unit, repeats, derivative.

    Parameters
    ----------
    files
        A file, a folder, or several of them.

    Raises
    ------
    DataError
        There is no such file, or something else than names of files is given.
    """
    given = [files] if isinstance(files, str | Path) else files
    if not isinstance(given, Sequence) or not all(isinstance(path, str | Path) for path in given):
        raise DataError(f"look: given {files!r}; give the name of a file or folder, or a list")
    return Look(look_at(Path(path) for path in given))
