"""The measured quantities as a page of the documentation."""

from pyrofit.quantities import known_quantities
from pyrofit.quantities.base import Quantity

_HEAD = """\
# Quantities

A signal of an experiment measures one of these quantities. The table lists the kinds of experiment
that measure it, the SI unit, the unit on figures, and the column of tidy files. A `cone` test
measures the quantities of a `gasification` test as well.
[Adding a quantity](adding.md#a-quantity) takes one file.

This page is generated: `pyrofit reference --of quantities > docs/quantities.md`.

| name | quantity | kinds of experiment | SI unit | shown in | column of tidy files |
|---|---|---|---|---|---|
"""
_READ = """
## Headers and units that are recognised

These headers of a value are recognised in measured files, with any unit of the kinds named.
A study may name any other column. `pyrofit init` recognises further spellings.

| name | headers | kinds of unit | a value holds for | largest value, SI units |
|---|---|---|---|---|
"""
_SAMPLING = {
    "point": "its time",
    "bin mean": "a bin around its time",
    "cumulative": "all time until then",
}


def quantities_page() -> str:
    """Return the page: every quantity with its units, columns and headers."""
    quantities = known_quantities().values()
    return "".join([_HEAD, *map(_row, quantities), _READ, *map(_read_row, quantities)])


def _row(quantity: Quantity) -> str:
    return (
        f"| `{quantity.name}` | {quantity.title} | {_codes(quantity.kinds)} "
        f"| {quantity.unit_text} | {quantity.shown.unit} | `{quantity.column}` |\n"
    )


def _read_row(quantity: Quantity) -> str:
    lowest, largest = quantity.largest
    return (
        f"| `{quantity.name}` | {_codes(quantity.headers)} | {', '.join(quantity.scales)} "
        f"| {_SAMPLING[quantity.sampling]} | {lowest:g} to {largest:g} |\n"
    )


def _codes(words: tuple[str, ...]) -> str:
    return ", ".join(f"`{word}`" for word in words)
