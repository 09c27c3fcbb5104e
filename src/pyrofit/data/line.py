"""A line of a delimited text file."""

from dataclasses import dataclass

BLANKS = " "
"""Delimiter of a file whose columns are set apart by any number of blanks."""


@dataclass(frozen=True)
class FileLine:
    """A line of the file, from 1, and its cells."""

    number: int
    cells: list[str]
