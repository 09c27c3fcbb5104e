"""Where model and measurement disagree."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.diagnosis_schema import OfWindow
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import MODELS, quantity_of_row, words_of
from pyrofit.show.table import Row, Table
from pyrofit.show.units import celsius, difference, difference_unit


def windows_table(study: Study, results: Results) -> pd.DataFrame:
    """List the intervals where the simulated curve is off to one side, and the conditions there."""
    return pd.DataFrame([_window(study, w) for w in diagnosis.read(study, results).windows])


def _window(study: Study, w: OfWindow) -> Row:
    quantity = quantity_of_row(study, w)
    unit = difference_unit(quantity).replace("–", "")
    relative = None if quantity.is_temperature else w.relative
    off = float(difference(quantity, w.mean))
    programme = None if w.start_K is None else (w.start_K, w.end_K)
    kelvin = programme or w.surface_temperature_K
    return {
        "model": MODELS.get(w.model, w.model),
        "experiment": title_of(study, w.experiment),
        "signal": words_of(study, w),
        "phase": w.phase,
        "time_s": range_text((w.start_s, w.end_s), ".0f"),
        "temperature_C": None if kelvin is None else range_text(celsius(kelvin), ".0f"),
        "conversion": range_text(w.conversion, ".2f"),
        "difference": f"{off:+.3g} {unit}".strip(),
        "relative_percent": np.nan if relative is None else 100.0 * relative,
    }


def range_text(pair: Sequence[float] | None, digits: str) -> str | None:
    """Write a range of values, nothing where there is none.

    >>> range_text([0.1, 0.25], ".2f")
    '0.10 to 0.25'
    """
    return None if pair is None else f"{pair[0]:{digits}} to {pair[1]:{digits}}"


TABLE = Table(
    place=100,
    make=windows_table,
    title="Where model and measurement disagree",
    note="Intervals in which the residuals are biased more strongly than by noise: 1 % of studies "
    "without misfit have such an interval. Temperature: of the surface, in TGA of the programme. "
    "Conversion: share of the whole release in the record. Difference: mean of simulated minus "
    "measured, also in per cent of the measured mean. It may be near zero, as the test allows for "
    "correlated noise. docs/diagnosis_method.md defines the phases.",
    headings={
        "time_s": "time [s]",
        "temperature_C": "temperature [°C]",
        "conversion": "conversion [-]",
        "relative_percent": "difference [%]",
    },
    group_by="model",
)
