"""Templates: input files with placeholders ``#name#``, filled with all digits of the values."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from pyrofit.errors import ProgramError, suggest

PLACEHOLDER = re.compile(r"#([A-Za-z_][A-Za-z0-9_]*)#")


def read_bytes(path: Path) -> bytes:
    """Return a file that a run needs.

    Raises
    ------
    ProgramError
        It cannot be read.
    """
    try:
        return path.read_bytes()
    except FileNotFoundError:
        near = [p.name for p in path.parent.iterdir()] if path.parent.is_dir() else []
        hint = suggest(path.name, near) if near else "Its folder is empty or missing, too."
        raise ProgramError(f"{path}: there is no such file. {hint}") from None
    except OSError as error:
        raise ProgramError(
            f"{path}: cannot be read ({error.strerror}); correct its rights"
        ) from None


def text_of(content: bytes) -> str:
    """Return the text of a template; `bytes_of` gives the same bytes again."""
    return content.decode("utf-8", "surrogateescape")


def bytes_of(text: str) -> bytes:
    """Return the bytes of a filled template."""
    return text.encode("utf-8", "surrogateescape")


def places_of_names(text: str) -> Iterator[tuple[str, int]]:
    """Yield name and line, from 1, of every placeholder.

    >>> list(places_of_names("k = #k#" + chr(10) + "### c = #c# ###"))
    [('k', 1), ('c', 2)]
    """
    for number, line in enumerate(text.split("\n"), start=1):
        for found in PLACEHOLDER.finditer(line):
            yield found[1], number


def check_template(path: str, text: str, known: Iterable[str]) -> None:
    """Refuse a template without placeholders, and one with unknown ones.

    Raises
    ------
    ProgramError
        With file and line.
    """
    known = set(known)
    found = list(places_of_names(text))
    if not found:
        raise ProgramError(
            f"{path}: there is no placeholder, so that all runs would be the same; put `#name#` "
            "where the value of a parameter belongs"
        )
    for name, line in found:
        if name not in known:
            raise ProgramError(
                f"{path}, line {line}: unknown placeholder '#{name}#'. {suggest(name, known)} "
                "Others are named under `placeholders`."
            )


def exact_number(value: float) -> str:
    """Return a number with all its digits.

    >>> exact_number(0.1), exact_number(1e-3 / 3.0), exact_number(5e20)
    ('0.1', '0.0003333333333333333', '5e+20')
    """
    return repr(float(value))


def fill_template(text: str, values: Mapping[str, float]) -> str:
    """Return the template with numbers in place of the placeholders.

    Raises
    ------
    ValueError
        A value is not finite.

    Examples
    --------
    >>> fill_template("CONDUCTIVITY=#k#,", {"k": 0.25})
    'CONDUCTIVITY=0.25,'
    """
    for name, _ in places_of_names(text):
        if not math.isfinite(values[name]):
            raise ValueError(f"the value of '#{name}#' is not finite")
    return PLACEHOLDER.sub(lambda found: exact_number(values[found[1]]), text)
