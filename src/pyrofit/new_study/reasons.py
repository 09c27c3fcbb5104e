"""Why a new study does not use a column of a file."""

import re

import numpy as np

from pyrofit.data.csvfile import FileTable, holds_unclear_numbers
from pyrofit.experiments import KINDS, OF_FILES, measurable
from pyrofit.new_study.headers import is_abscissa, is_foreign, is_usual, may_be, stem_of
from pyrofit.new_study.units import kind_of_unit
from pyrofit.quantities.units import header_key

NO_VALUES = "it holds no values"
PLACEHOLDER = "zero throughout, a placeholder"
_DERIVATIVE = re.compile(r"dtg.*|ddsc.*|d[tmw]?/d[tT].*|deriv.*|.*derivative.*")
_LOSS = re.compile(r"(mass|weight)loss(?!rate).*")
_CHANGE = re.compile(r"(delta|d|Δ|δ)m(ass)?|(mass|weight)(change|variation|anderung|änderung)")
_TOTAL = re.compile(r"thr|(total|cumul|integr)(?!.*rate).*heat.*|.*heatreleased.*")
_MEASURED = re.compile(r"t|t[^a-z].*|t(gas|top|front|back|surf).*|.*temp.*|.*(flow|mdot|flux).*")


def is_stated_change(table: FileTable, header: str) -> bool:
    """Tell whether a column is a change of mass that the file says how to read.

    It is in units of a fraction, or the file states the initial mass.
    """
    told = kind_of_unit(table.units[header] or "", ("fraction",)) or table.stated.mass_kg
    return bool(told and _CHANGE.fullmatch(header_key(header)))


def is_empty(table: FileTable, header: str) -> bool:
    """Tell whether a column holds nothing but zeros and cells without a value, or text."""
    return not np.nan_to_num(table.columns[header]).any() and not holds_unclear_numbers(
        table, header
    )


def why_unused(table: FileTable, header: str, kind: str) -> str:
    """Say why a column that is no quantity of a kind of experiment is left out."""
    if is_empty(table, header) and header not in table.faults:
        return NO_VALUES if np.isnan(table.columns[header]).all() else PLACEHOLDER
    if header in table.faults and np.isnan(table.columns[header]).all():
        return "it holds text"
    if _DERIVATIVE.fullmatch(stem_of(header)):
        return "it is the derivative of another column"
    if _LOSS.fullmatch(stem_of(header)):
        return "it is a loss of mass; make the mass a column, such as 100 minus a loss in %"
    if _CHANGE.fullmatch(header_key(header)):
        return "it is a change of mass; name it as the value, and give `sample_mass_kg`"
    if _TOTAL.fullmatch(stem_of(header)):
        return "it is a total over the test, not a rate"
    if _is_of_apparatus(header, kind):
        return "it belongs to a gas or the apparatus, not to the sample"
    if any(is_abscissa(header, role) for role in ("time", "temperature")):
        return "another column is taken for the time or the temperature, or several may be it"
    others = _other_kinds(header, kind)
    if others:
        quantity, kinds = others
        options = " or ".join(f"--{other}" for other in kinds)
        return (
            f"it is a {quantity}, which the model does not predict for a {KINDS[kind].words} test; "
            f"give the file after {options} if it is one"
        )
    return "not recognised"


def _is_of_apparatus(header: str, kind: str) -> bool:
    """Tell whether a header names a flow or a temperature of a gas or of the apparatus.

    The temperature of a furnace may stand for that of a heated sample.
    """
    if not is_foreign(header) or not _MEASURED.fullmatch(stem_of(header)):
        return False
    heated = any(quantity.against_temperature for quantity in measurable(kind).values())
    return not (heated and is_abscissa(header, "temperature"))


def _other_kinds(header: str, kind: str) -> tuple[str, list[str]] | None:
    """Return the title of the quantity that a header names, and the kinds that measure it."""
    own = measurable(kind)
    found: dict[str, list[str]] = {}
    for other in (n for n, k in OF_FILES.items() if k.stage == KINDS[kind].stage):
        for name, quantity in measurable(other).items():
            known = is_usual(header, quantity) or may_be(header, quantity)
            if name not in own and known:
                found.setdefault(quantity.title, []).append(other)
    return next(iter(found.items())) if len(found) == 1 else None
