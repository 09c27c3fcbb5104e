"""Which header may be that of which quantity, by its words."""

import re
from collections.abc import Sequence

from pyrofit.new_study.languages import english
from pyrofit.new_study.units import split_unit
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import header_key

_ERROR = re.compile(r"err(or)?|unc(ertainty)?|sigma|std(ev|dev)?|deviation|sd$")
_PLACES = (
    *("exhaust", "duct", "stack", "flue", "chimney", "hood", "heater", "furnace", "oven"),
    *("ambient", "room", "surround", "environment", "purge", "carrier", "coolant"),
    *("abluft", "ofen", "heizer", "raum", "umgebung"),
)
_GASES = ("air", "luft", "n2", "o2", "ar", "he", "nitrogen", "oxygen", "argon", "stickstoff")
_KINDS_OF_GAS = ("off", "flue", "exhaust", "purge", "carrier", "process", "ab", "spül")
_APPARATUS = re.compile(
    rf"t?({'|'.join(_KINDS_OF_GAS)})?gas(es|temp.*|flow.*)?|({'|'.join(_PLACES)}).*"
    rf"|{'|'.join(_GASES)}"
)
"""Words for parts of the apparatus and for gases, of which flows and temperatures are recorded."""
_OF_SAMPLE = re.compile(
    r"sample(?!purge|gas)|specimen|probe|mlr|massloss|massenverlust|abbrand|hrr|heatrelease"
)
_WORDS = {
    "time": r"time.*|date/?time|(elapsed|test)time|zeit|clock(time)?",
    "temperature": r"(sample|program|furnace)?temp.*|(proben|ofen)temp.*|ts|tp|tsample",
}


def is_usual(name: str, quantity: Quantity) -> bool:
    """Tell whether the reader knows a header by itself."""
    return english(header_key(name)) in {header_key(usual) for usual in quantity.headers}


def is_abscissa(name: str, role: str) -> bool:
    """Tell whether a header may be that of the time, or of the temperature of a heated sample."""
    stem = stem_of(name)
    if stem == "t":  # the symbols: t for time, T for a temperature
        return role == ("time" if name.startswith("t") else "temperature")
    return not _ERROR.search(stem) and bool(re.fullmatch(_WORDS[role], stem))


def is_of_sample(name: str) -> bool:
    """Tell whether a header of a temperature names the sample's, and not that of the furnace."""
    return bool(re.match(r"sample|probe|ts$|t(emp(erature)?)?sample", stem_of(name)))


def is_foreign(name: str) -> bool:
    """Tell whether a header names a gas or a part of the apparatus, and not the sample.

    >>> [is_foreign(name) for name in ("Temp exhaust", "mdot_N2", "MLR_N2", "T_back")]
    [True, True, False, False]
    """
    words = re.split(r"[\W_]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", split_unit(name)[0]))
    foreign = any(_APPARATUS.fullmatch(word.casefold()) for word in words)
    return foreign and not _OF_SAMPLE.search(stem_of(name))


def may_be(name: str, quantity: Quantity) -> bool:
    """Tell whether the words of a header are those of a quantity."""
    stem = stem_of(name)
    if _ERROR.search(stem) or is_foreign(name):
        return False
    if stem == "t":  # the symbol of a temperature
        return name.startswith("T") and quantity.is_temperature
    return bool(re.fullmatch(quantity.pattern, stem))


def stem_of(name: str) -> str:
    """Return a header without its unit, as it is compared with others."""
    return english(header_key(split_unit(name)[0]))


def is_error(
    name: str, quantity: Quantity, header: str, order: Sequence[str], values: Sequence[str]
) -> bool:
    """Tell whether a column is the uncertainty of another.

    One without a word for its quantity is that of the value to its left.

    Parameters
    ----------
    name
        The column.
    quantity, header
        Quantity and column of the value.
    order
        All columns, from left to right.
    values
        Those of all values.
    """
    rest, errors = _ERROR.subn("", stem_of(name))
    if not errors or rest:
        return bool(errors) and bool(re.fullmatch(quantity.pattern, rest))
    before = [v for v in order[: order.index(name)] if v in values]
    return header == (before[-1] if before else values[0])


def root_of_header(name: str) -> str:
    """Return a header without its unit and the number at its end."""
    return re.sub(r"\d+$", "", stem_of(name))
