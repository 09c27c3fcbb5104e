"""The columns of time and temperature, which the signals of a file share."""

from collections.abc import Sequence

import numpy as np

from pyrofit.data.csvfile import FileTable
from pyrofit.new_study.headers import is_abscissa, is_foreign, is_of_sample
from pyrofit.new_study.units import kind_of_unit, stated_unit
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import SCALES, ZEROS_K, header_key, unit_key

_SAME = 1e-3
"""Largest difference of two columns of the same times, as a fraction of the last one."""


def abscissa_candidates(
    table: FileTable, quantities: Sequence[Quantity], role: str, empty: Sequence[str]
) -> list[str]:
    """Return the columns that may be the time or the temperature; one where it is clear.

    Of several that agree, one is taken; of several temperatures, that of the sample. Where no name
    tells one, that of its unit is taken: a time that rises, a temperature of no other body.
    """
    free = [n for n in table.columns if role == "time" or n not in empty]
    usual = {header_key(name) for q in quantities for name in q.roles.get(role, ())}
    known = [n for n in free if header_key(n) in usual]
    named = [n for n in free if is_abscissa(n, role)]
    if not known and not named:
        return _by_unit(table, free, role)
    if role == "temperature":
        # Beside the programme's or the furnace's stands that of the sample.
        of_sample = [n for n in named if is_of_sample(n)]
        possible = of_sample if len(of_sample) == 1 else known or of_sample or named
        return possible[:1] if len(possible) > 1 and _agree(table, possible, role) else possible
    numbers = [n for n in known or named if not np.isnan(table.columns[n]).all()]
    if len(numbers) > 1 and _agree(table, numbers, role):
        return numbers[:1]
    return numbers or known or named


def _by_unit(table: FileTable, names: Sequence[str], role: str) -> list[str]:
    """Return the one column with a unit of a role; none where several have it."""
    units = {n: stated_unit(table, n, (role,)) for n in names if not is_foreign(n)}
    of_role = [n for n, (unit, read) in units.items() if read and kind_of_unit(unit, (role,))]
    if len(of_role) != 1 or (role == "time" and (np.diff(table.columns[of_role[0]]) < 0.0).any()):
        return []
    return of_role


def _agree(table: FileTable, names: Sequence[str], role: str) -> bool:
    """Tell whether columns hold the same times or temperatures, each in its own unit."""
    found = []
    for name in names:
        unit, read = stated_unit(table, name, (role,))
        word = next((w for w in SCALES[role] if unit_key(w) == unit_key(unit)), None)
        if not read or word is None:
            return False
        found.append(SCALES[role][word] * table.columns[name] + ZEROS_K.get(word, 0.0))
    span = float(np.nanmax(np.abs(found[0])))
    first, *others = found
    return all(np.allclose(other, first, 0.0, _SAME * span, equal_nan=True) for other in others)
