"""Fortran namelists as FDS reads them: written with nine digits, and read back."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

Item = bool | float | int | str
"""A value of a key."""
Items = Mapping[str, Item | Sequence[Item]]
"""Values by key; several are written one after the other."""
_WIDTH = 78


class Namelist(NamedTuple):
    """A group with its keys, and comment lines ahead of it."""

    group: str
    items: Items
    comment: tuple[str, ...] = ()


def nine_digits(value: float) -> str:
    """Return a number with nine digits: four digits of E would change a rate by 1 %.

    >>> nine_digits(24728.593312345), nine_digits(0.2)
    ('24728.5933', '0.2')
    """
    return f"{float(value):.9g}"


def _text(item: Item) -> str:
    if isinstance(item, bool):
        return ".TRUE." if item else ".FALSE."
    if isinstance(item, str):
        return "'" + item.replace("'", "") + "'"
    return nine_digits(item)


def _value(value: Item | Sequence[Item]) -> str:
    several = isinstance(value, Sequence) and not isinstance(value, str)
    return ",".join(map(_text, value if several else [value]))  # type: ignore[arg-type]


def write(namelist: Namelist) -> str:
    """Return the lines of a namelist.

    >>> print(write(Namelist("RAMP", {"ID": "k", "T": 20.0, "F": 0.2})), end="")
    &RAMP ID='k', T=20, F=0.2 /
    """
    comment = "".join(f"{comment_line(line)}\n" for line in namelist.comment)
    pairs = [f"{key}={_value(value)}" for key, value in namelist.items.items()]
    short = " ".join(filter(None, [f"&{namelist.group}", ", ".join(pairs), "/"]))
    if len(short) <= _WIDTH:
        return f"{comment}{short}\n"
    return f"{comment}&{namelist.group} " + ",\n      ".join(pairs) + " /\n"


def comment_line(text: str) -> str:
    """Return a comment of ASCII characters without the signs that begin or end a namelist.

    >>> comment_line("25 kW/m² & more")
    '! 25 kW/m2 + more'
    """
    for sign, plain in _PLAIN.items():
        text = text.replace(sign, plain)
    return f"! {text.encode('ascii', 'replace').decode()}".rstrip()


_PLAIN = {"²": "2", "³": "3", "±": "+-", "°": "", "–": "-", "·": " ", "&": "+", "\n": " "}


def write_all(namelists: Iterable[Namelist]) -> str:
    """Return the lines of several namelists."""
    return "".join(map(write, namelists))


def unique(names: Iterable[str], most: int) -> dict[str, str]:
    """Return identifiers of at most ``most`` characters by name, all different.

    FDS cuts longer ones without a word, so that two might become one.

    >>> unique(["extra_char", "extra_charm", "a b"], 9)
    {'extra_char': 'extra_cha', 'extra_charm': 'extra_c_2', 'a b': 'a_b'}
    """
    found: dict[str, str] = {}
    for name in names:
        plain = "".join(c if c.isascii() and (c.isalnum() or c in "_-") else "_" for c in name)
        candidate, n = plain[:most], 1
        while candidate in found.values():
            n += 1
            candidate = f"{plain[: most - len(str(n)) - 1]}_{n}"
        found[name] = candidate
    return found
