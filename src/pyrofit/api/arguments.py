"""Kinds of arguments, checked: paths, words, numbers, functions."""

import math
import os
from collections.abc import Callable, Collection, Iterable
from numbers import Real
from pathlib import Path
from typing import Any

from pyrofit.errors import StudyError, suggest


def wrong(argument: str, needed: str, given: Any) -> StudyError:
    """Return the error of an argument of another kind than needed.

    >>> print(wrong("path", "the path of a file", 3))
    path: the path of a file is needed, and this is a int: 3
    """
    shown = repr(given)
    shown = f": {shown}" if len(shown) <= 40 and "\n" not in shown else ""
    return StudyError(
        f"{argument}: {needed} is needed, and this is a {type(given).__name__}{shown}"
    )


def path_of(argument: str, given: Any) -> Path:
    """Return a path; refuse anything else.

    >>> path_of("path", "a.yaml").name
    'a.yaml'
    """
    if not isinstance(given, str | os.PathLike):
        raise wrong(argument, "the path of a file or folder", given)
    return Path(given)


def paths_of(argument: str, given: Any) -> list[Path]:
    """Return a list of paths; one path alone is a list of one."""
    if isinstance(given, str | os.PathLike):
        return [Path(given)]
    if not isinstance(given, Iterable):
        raise wrong(argument, "a list of paths", given)
    return [path_of(argument, one) for one in given]


def word_of(argument: str, given: Any, known: Collection[str] = ()) -> str:
    """Return a word; refuse anything else, and unknown words.

    >>> word_of("stage", "im", ["kinetics", "imp"])
    Traceback (most recent call last):
    pyrofit.errors.StudyError: unknown stage 'im'. Did you mean 'imp'? Known: imp, kinetics.
    """
    if not isinstance(given, str):
        raise wrong(argument, "a word", given)
    if known and given not in known:
        raise StudyError(f"unknown {argument} '{given}'. {suggest(given, known)}")
    return given


def number_of(argument: str, given: Any, above: float = -math.inf) -> float:
    """Return a finite number above a limit; refuse all else."""
    needed = "a finite number" + (f" above {above:g}" if math.isfinite(above) else "")
    if isinstance(given, bool) or not isinstance(given, Real) or not math.isfinite(given):
        raise wrong(argument, needed, given)
    if float(given) <= above:
        raise wrong(argument, needed, given)
    return float(given)


def count_of(argument: str, given: Any) -> int:
    """Return a whole number from 1 on; refuse all else."""
    if isinstance(given, bool) or not isinstance(given, int) or given < 1:
        raise wrong(argument, "a whole number from 1 on", given)
    return given


def teller_of(given: Any) -> Callable[[str], None]:
    """Return the function that hears of the progress; one that is None says nothing."""
    if given is None:
        return lambda text: None
    if not callable(given):
        raise wrong("tell", "a function such as print", given)
    found: Callable[[str], None] = given
    return found
