"""The series of a file from which a study is made, as far as they can be read."""

from collections.abc import Iterable
from typing import NamedTuple

import pandas as pd

from pyrofit.data.csvfile import FileTable
from pyrofit.data.series import read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError
from pyrofit.new_study.columns import FoundColumn, Recognised
from pyrofit.new_study.divisor import divisor_of

START_K = 300.0
"""Temperature assumed at time 0 of a record without temperatures."""
_TOLD = ("thinned", "left out, the time of", "left out, before", "a change of mass")
"""Beginnings of the notes of the reader that a new study tells."""


class StatedCourse(NamedTuple):
    """Heating rate and first temperature that stand for a missing column."""

    rate_K_s: float | None = None
    start_K: float | None = None


def lacking(recognised: Recognised) -> str:
    """Return the column that all signals of a heated sample lack, if the rest tells it."""
    signals = recognised.signals
    missing = {found.missing for found in signals if found.of.against_temperature}
    if len(missing) != 1 or not all(found.of.against_temperature for found in signals):
        return ""
    if missing == {("time",)} and recognised.timeless:
        return "time"
    return "temperature" if missing == {("temperature",)} and not recognised.left else ""


def frames_of(
    table: FileTable, signals: Iterable[FoundColumn], course: StatedCourse
) -> tuple[dict[str, pd.DataFrame], tuple[str, ...]]:
    """Return the series that can be read, and whether they are thinned.

    `pyrofit check` reports the faults of the others.
    """
    frames: dict[str, pd.DataFrame] = {}
    thinned: dict[str, None] = {}
    for found in signals:
        if found.missing or found.unread or found.quantity in frames:
            continue
        divisor = dict([given]) if (given := divisor_of(found)) else {}
        spec = SeriesSpec(
            found.quantity,
            table.path,
            found.columns,
            found.units,
            sample_area_m2=divisor.get("sample_area_m2"),
            sample_mass_kg=divisor.get("sample_mass_kg"),
            sign=-1 if found.of.has_sign and found.stated.exothermic_up else 1,
            from_first=found.dried_to is not None,
            rate_K_s=course.rate_K_s,
            start_K=course.start_K,
        )
        try:
            series = read_series(spec, lambda _: table)
        except DataError:
            continue
        frames[found.quantity] = series.frame
        thinned |= dict.fromkeys(note for note in series.notes if note.startswith(_TOLD))
    return frames, tuple(thinned)
