"""Facts that tables, figures and sentences of the scores share."""

from collections.abc import Iterable

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.steps.rescore import record
from pyrofit.steps.rescore.record import OfMeasure, Rescored


def shown_by_rank(found: Rescored) -> list[OfMeasure]:
    """Return the costs to show: of those that rank the sets in the same order, the first."""
    again = {name for group in found.same for name in group[1:]}
    return [m for m in found.measures if m.name not in again]


def of_shown(found: Rescored, matrix: pd.DataFrame) -> pd.DataFrame:
    """Return the part of a square table that belongs to the costs shown."""
    names = [m.name for m in shown_by_rank(found) if m.name in matrix]
    return matrix.loc[names, names]


def correlation_of_shown(study: Study, results: Results) -> pd.DataFrame:
    """Return the rank correlation of the costs shown."""
    return of_shown(record.read(study, results), record.matrix(results, record.CORRELATION))


def in_study_units(study: Study, values: Iterable[tuple[str, float]]) -> dict[str, float]:
    """Return parameters in the study's units, by name and unit."""
    found = {}
    for name, value in values:
        parameter = study.parameters[name]
        found[f"{name} [{parameter.unit}]"] = value / parameter.factor
    return found
