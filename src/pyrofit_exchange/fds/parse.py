"""Namelists read from a file of FDS."""

import re
from collections.abc import Iterator
from typing import Any

from pyrofit_exchange.fds.versions import FdsError

Values = list[Any]
Read = tuple[str, dict[str, Values], int]
"""Group, values by key, and the line in which it begins."""

_TOKEN = re.compile(
    r"\s*(?:(?P<text>'[^']*'|\"[^\"]*\")|(?P<key>[A-Za-z_]\w*(?:\([^)]*\))?)\s*=|(?P<end>/)"
    r"|(?P<comment>![^\n]*)|(?P<word>[^\s,=/'\"!]+)|(?P<comma>,))"
)


def read_namelists(text: str, source: str) -> Iterator[Read]:
    r"""Yield the namelists of a file; keys keep their places, as ``NU_MATL(1,1)``.

    Parameters
    ----------
    text
        Content of the file; text outside of namelists is a comment.
    source
        Its name, for messages.

    Raises
    ------
    FdsError
        A namelist does not end, or holds a word that is no value.

    Examples
    --------
    >>> list(read_namelists("x\n&RAMP ID='k', T=20., F=2*0.1 /", "a.fds"))
    [('RAMP', {'ID': ['k'], 'T': [20.0], 'F': [0.1, 0.1]}, 2)]
    """
    at = 0
    while found := re.compile(r"^[ \t]*&([A-Za-z]\w*)", re.M).search(text, at):
        line = text.count("\n", 0, found.end(1)) + 1
        keys, at = _keys(text, found.end(), f"{source}, line {line}, {found[1].upper()}")
        yield found[1].upper(), keys, line


def _keys(text: str, at: int, place: str) -> tuple[dict[str, Values], int]:
    """Return the keys of a namelist and where it ends."""
    keys: dict[str, Values] = {}
    key = ""
    while found := _TOKEN.match(text, at):
        at = found.end()
        if found["end"]:
            return keys, at
        if found["key"]:
            key = re.sub(r"\s", "", found["key"]).upper()
            keys[key] = []
        elif found["text"]:
            keys.setdefault(key, []).append(found["text"][1:-1])
        elif found["word"]:
            if not key:
                raise FdsError(f"{place}: '{found['word']}' belongs to no key; correct it")
            keys[key] += _word(found["word"], f"{place}, {key}", not keys[key])
    raise FdsError(f"{place}: it does not end; add the / at its end")


def _word(word: str, place: str, is_first: bool) -> Values:
    """Return the values of a word: a number, a logical, or several of one by ``3*``.

    The first word of a key may be text without quotes, which compilers read as well.
    """
    count, star, rest = word.partition("*")
    if star and count.isdigit():
        return int(count) * _word(rest, place, False)
    logical = word.strip(".").upper()
    if logical in ("TRUE", "T", "FALSE", "F"):
        return [logical.startswith("T")]
    try:
        return [float(re.sub("[dD]", "E", word))]
    except ValueError:
        if is_first and re.fullmatch(r"[A-Za-z][\w.-]*", word):
            return [word]
        raise FdsError(f"{place}: '{word}' is no number; correct it") from None
