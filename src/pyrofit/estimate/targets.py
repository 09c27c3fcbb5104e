"""Targets of the terms of a cost: parts of the measured series."""

from collections.abc import Mapping

import pandas as pd

from pyrofit.config import Study, TermSpec
from pyrofit.cost import Target, Term, make_term
from pyrofit.quantities.base import Quantity

Measurements = Mapping[tuple[str, str], pd.DataFrame]
"""Measured series by (experiment, signal)."""


def target_of(frame: pd.DataFrame, quantity: Quantity) -> Target:
    """Return the measured series as the target of a cost."""
    sigma = quantity.uncertainty_column
    return Target(
        frame["time_s"].to_numpy(float),
        frame[quantity.column].to_numpy(float),
        frame[sigma].to_numpy(float) if sigma in frame else None,
    )


def target_for(study: Study, spec: TermSpec, measurements: Measurements) -> Target:
    """Return the target of a term: its window of the measured series, resampled where wanted.

    Raises
    ------
    CostError
        The window holds too few points.
    """
    quantity = study.experiments[spec.experiment].quantity(spec.signal)
    return _compared(spec, target_of(measurements[spec.experiment, spec.signal], quantity))


def _compared(spec: TermSpec, series: Target) -> Target:
    """Return the part of a series that a term compares, at the times where it does."""
    if spec.window_s is not None:
        series = series.window(*spec.window_s)
    return series.resampled(spec.points) if spec.points else series


def term_for(study: Study, spec: TermSpec, measurements: Measurements) -> Term:
    """Return a term of a cost, ready for models at the times of its target.

    Raises
    ------
    CostError
        The window holds too few points, or the cost does not fit the target.
    """
    options = spec.all_options()
    if spec.limits is not None:
        frame = measurements[spec.experiment, spec.signal]
        time = frame["time_s"].to_numpy(float)
        quantity = study.experiments[spec.experiment].quantity(spec.signal)
        for role, column in quantity.limit_columns.items():
            options[role] = _compared(spec, Target(time, frame[column].to_numpy(float))).value
    return make_term(spec.kind, target_for(study, spec, measurements), **options)
