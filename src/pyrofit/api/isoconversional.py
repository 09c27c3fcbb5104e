"""Activation energy over conversion, from the masses of a study or from arrays."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeGuard

import numpy as np
import pandas as pd

from pyrofit.analysis.isoconversional.analyse import Analysis, analyse
from pyrofit.analysis.isoconversional.curve import Curve, curve_of
from pyrofit.analysis.isoconversional.findings import findings
from pyrofit.analysis.isoconversional.records import (
    FEWEST,
    LEAST_LOST,
    applies,
    masses,
    measured_curves,
    simulated_curves,
)
from pyrofit.api.arguments import number_of
from pyrofit.api.choices import complete, si_values
from pyrofit.api.measurements import Data, read_measured
from pyrofit.api.studies import Source, read_study
from pyrofit.config import Study
from pyrofit.config.resolve import diagnosed_material
from pyrofit.errors import DataError, StudyError
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.outputs import MASS_FRACTION

_COLUMNS = ("time_s", "temperature_K", MASS_FRACTION)
_HELD_K = 5.0
"""Rise of the temperature up to which a record counts as a hold."""


@dataclass(frozen=True, eq=False)
class Isoconversional:
    """Activation energy over conversion; print it for a report.

    Parameters
    ----------
    table
        E by conversion [kJ/mol]: columns ``friedman_kJ_mol``, ``kas_kJ_mol``,
        ``vyazovkin_kJ_mol``, each with ``..._error_kJ_mol``, half of a 95 % interval. With values
        of a model, ``model_friedman_kJ_mol`` and so on: the same method on the model's curves.
    warnings
        What the analysis shows, in sentences.
    temperature_sd_K
        Standard deviation of the temperature of a record that the errors contain.
    """

    table: pd.DataFrame
    warnings: list[str]
    temperature_sd_K: float

    def __str__(self) -> str:
        """Return the table and the warnings."""
        return "\n".join([self.table.round(2).to_string(index=False), *self.warnings])

    __repr__ = __str__


def isoconversional(
    study: Source | Mapping[str, Any],
    values: Mapping[str, float] | None = None,
    *,
    data: Data | None = None,
    temperature_sd_K: float | None = None,
) -> Isoconversional:
    """Return the activation energy over conversion by Friedman, KAS and advanced Vyazovkin.

    The methods are those of Vyazovkin et al. 2011, doi 10.1016/j.tca.2011.03.034. They need the
    mass at two heating programmes at least, and know no model of the reactions. KAS is for constant
    heating rates. Repeats of a programme are averaged.

    Parameters
    ----------
    study
        A study, its file, or its keys; or tables by name with the columns ``time_s``,
        ``temperature_K`` and ``mass_fraction``, or arrays with these three columns.
    values
        Values of a model's parameters, such as the ``values`` of a fit, in the units of the study:
        its curves are analysed alike.
    data
        Series that replace those of the study, see `read_data`.
    temperature_sd_K
        Standard deviation of the temperature of a record about that of the others; default: by
        repeats, and 0.5 K where there are none.

    Raises
    ------
    StudyError
        There is no mass of two heating programmes, or a parameter has no value.
    DataError
        A file or table is missing or breaks a rule.

    Examples
    --------
    >>> import numpy as np
    >>> import pyrofit as pf
    >>> records = {}
    >>> for rate in (5.0, 10.0, 20.0):  # one reaction of 150 kJ/mol
    ...     time = np.linspace(0.0, 450.0 * 60.0 / rate, 4001)
    ...     T = 400.0 + rate / 60.0 * time
    ...     k = 1e-3 * np.exp(-150e3 / 8.314462618 * (1.0 / T - 1.0 / 600.0))
    ...     passed = np.append(0.0, np.cumsum(0.5 * (k[1:] + k[:-1]) * np.diff(time)))
    ...     records[f"{rate:g} K/min"] = np.column_stack([time, T, np.exp(-passed)])
    >>> found = pf.isoconversional(records)
    >>> [round(float(E)) for E in found.table["vyazovkin_kJ_mol"][[1, 9, 17]]]
    [150, 150, 150]
    >>> found.warnings
    []
    """
    if temperature_sd_K is not None:
        number_of("temperature_sd_K", temperature_sd_K, above=0.0)
    if _is_records(study):
        if values is not None:
            raise StudyError("values of a model need a study; give it in place of the tables")
        curves = [_of_table(str(name), table) for name, table in study.items()]
        return _result(_analysed(curves, [], temperature_sd_K))
    described = read_study(study)
    if not applies(described):
        raise StudyError(
            f"study '{described.name}' has no mass of {FEWEST} heating programmes: activation "
            "energies come from the differences between programmes. Add TGA at other rates"
        )
    series = read_measured(described, list(masses(described).items()), data)
    model = [] if values is None else _model(described, values, series)
    return _result(_analysed(measured_curves(described, series), model, temperature_sd_K))


def _is_records(given: object) -> TypeGuard[Mapping[str, Any]]:
    tables = (pd.DataFrame, np.ndarray, list, tuple)
    return (
        isinstance(given, Mapping)
        and bool(given)
        and all(isinstance(table, tables) for table in given.values())
    )


def _model(study: Study, values: Mapping[str, float], series: Mapping[Any, Any]) -> list[Curve]:
    every = complete(study, si_values(study, values), list(masses(study)))
    return simulated_curves(study, diagnosed_material(study), every, series)


def _analysed(curves: list[Curve], model: list[Curve], sd: float | None) -> Analysis:
    if len({curve.condition for curve in curves}) < FEWEST:
        raise StudyError(
            f"{FEWEST} heating programmes at least are needed: activation energies come from the "
            "differences between them"
        )
    for curve in curves:
        if curve.lost < LEAST_LOST:
            raise DataError(
                f"{curve.name}: the mass falls by less than {LEAST_LOST:g} of the initial mass, so "
                "there is no conversion; leave this record out"
            )
    return analyse(curves, model, sd)


def _result(analysis: Analysis) -> Isoconversional:
    return Isoconversional(analysis.table, findings(analysis), analysis.temperature_sd_K)


def _of_table(name: str, table: Any) -> Curve:
    """Return the conversion of a table or an array of time, temperature and mass."""
    if isinstance(table, pd.DataFrame):
        lacking = [column for column in _COLUMNS if column not in table]
        if lacking:
            raise DataError(f"'{name}' has no column {lacking[0]}; it needs {', '.join(_COLUMNS)}")
        columns = [table[column].to_numpy(float) for column in _COLUMNS]
    else:
        array = np.asarray(table, dtype=float)
        array = array.T if array.ndim == 2 and array.shape[0] == 3 != array.shape[1] else array
        if array.ndim != 2 or array.shape[1] != 3:
            raise DataError(
                f"'{name}' has the shape {array.shape}; it needs three columns: time [s], "
                "temperature [K], mass over initial mass"
            )
        columns = list(array.T)
    time, temperature, mass = columns
    if not all(np.isfinite(c).all() for c in columns) or not (np.diff(time) > 0.0).all():
        raise DataError(f"'{name}': times must increase, and all cells must be numbers")
    rate = _rate(time, temperature)
    held = f"{round(float(np.median(temperature)))} K"
    condition = held if rate is None else f"{rate:g} K/min"
    return curve_of(name, condition, rate, time, temperature, mass)


def _rate(time: FloatArray, temperature: FloatArray) -> float | None:
    """Return the heating rate [K/min] to two digits, none of a hold."""
    rise = float(temperature[-1] - temperature[0])
    if rise < _HELD_K:
        return None
    return float(f"{60.0 * rise / float(time[-1] - time[0]):.2g}")
