"""Measured series: those that a caller gives, those in files, and computed ones."""

import inspect
import tempfile
import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.api.choices import Key, Signals, key_of, signals_of
from pyrofit.api.curves import MEASURED, Curves, with_unit_attributes
from pyrofit.api.given_tables import as_table, indexed, named_in_memory
from pyrofit.api.studies import Source, read_study
from pyrofit.config import Study
from pyrofit.data.suspect import LOOK
from pyrofit.errors import DataError
from pyrofit.model.signal import Signal
from pyrofit.quantities.base import Quantity
from pyrofit.results.files import write_csv
from pyrofit.stages.measurements import computed
from pyrofit.stages.reading import SYNTHETIC, read_all

Data = Mapping[Any, Any] | Curves
"""Tables or arrays by (experiment, signal); by experiment tables, or arrays of its one signal."""


def read_data(study: Source, signals: Signals | None = None, data: Data | None = None) -> Curves:
    """Return the measured series of a study in SI units, checked.

    Parameters
    ----------
    study
        A study, its file, or its keys.
    signals
        Experiments, or signals by experiment; by default all.
    data
        Series that replace those of the study, by (experiment, signal). A table has the columns
        and units of a measured file, or those that this function returns; given by experiment, it
        holds all its signals. An array has the
        columns time [s], temperature [K] of heated samples, value, and maybe uncertainty, in SI
        units. Those of a heated sample may be temperature and value alone. A tuple holds columns.

    Returns
    -------
    Curves
        The notes of the reader, such as on cells without a value, are in ``table.attrs["notes"]``,
        and stand below the list of the series.

    Raises
    ------
    DataError
        A file or table is missing or breaks a rule.
    StudyError
        The study has no such experiment or signal.
    """
    study = read_study(study)
    wanted = signals_of(study, list(study.experiments) if signals is None else signals)
    return Curves(study, read_measured(study, wanted, data), MEASURED)


def read_measured(
    study: Study, wanted: Iterable[Key], data: Data | None
) -> dict[Key, pd.DataFrame]:
    """Return some measured series; only these are read or computed."""
    given = _given(study, data)
    keys = list(dict.fromkeys(wanted))
    checked = {key: given[key] for key in keys if key in given and _is_checked(study, key, data)}
    rest = _read_or_computed(study, [key for key in keys if key not in checked], given)
    found = checked | rest
    return {
        key: with_unit_attributes(found[key], study.experiments[key[0]].quantity(key[1]))
        for key in keys
    }


def read_to_fit(study: Study, wanted: Iterable[Key], data: Data | None) -> dict[Key, pd.DataFrame]:
    """Return some measured series, and warn of those that are suspect, as `pyrofit check` does."""
    found = read_measured(study, wanted, data)
    for (name, signal), frame in found.items():
        for note in frame.attrs.get("notes", []):
            if note.startswith(LOOK):
                line = f"study '{study.name}': {name}, {signal}: {note}"
                warnings.warn(line, stacklevel=_level_outside())
    return found


def _level_outside() -> int:
    """Return the stack level, for the function that warns, of the code that calls pyrofit."""
    level, frame = 0, inspect.currentframe()
    while frame and frame.f_globals.get("__name__", "").startswith("pyrofit."):
        level, frame = level + 1, frame.f_back
    return level


def _is_checked(study: Study, key: Key, data: Data | None) -> bool:
    """Tell whether a series is one of `read_data` for this experiment, unchanged since.

    A caller may have changed the numbers of its table: those that no series has are read again,
    with the messages of the reader.
    """
    if not isinstance(data, Curves) or data.words != MEASURED:
        return False
    name = key[0]
    if data.study is not study and data.study.experiments.get(name) != study.experiments[name]:
        return False
    frame = data.series[key]
    if not all(pd.api.types.is_float_dtype(kind) for kind in frame.dtypes):
        return False
    numbers = frame.to_numpy(float)
    time = frame["time_s"].to_numpy(float)
    return bool(len(time) > 2 and np.isfinite(numbers).all() and (np.diff(time) > 0.0).all())


def _read_or_computed(
    study: Study, keys: Iterable[Key], given: Mapping[Key, Any]
) -> dict[Key, pd.DataFrame]:
    """Return series from files and tables, read and checked, and those of the study's truth."""
    keys = list(keys)
    if not keys:
        return {}
    with tempfile.TemporaryDirectory() as folder:
        signals: dict[Key, Signal] = {}
        labels: dict[str, str] = {}
        for key in keys:
            quantity = study.experiments[key[0]].quantity(key[1])
            timeless = getattr(study.experiments[key[0]], "program", "") == "from_temperature"
            signals[key] = study.experiments[key[0]].signals[key[1]]
            if key in given:
                path = Path(folder) / f"{'_'.join(key)}.csv"
                label = f"data of {key[0]}, {key[1]}"
                table = as_table(given[key], quantity, label)
                write_csv(path, table)
                labels[str(path)] = label
                signals[key] = _from_table(signals[key], quantity, path, table, timeless)
        return _read(_with_signals(study, signals), labels)


def given_keys(study: Study, data: Data | None) -> list[Key]:
    """Return experiment and signal of each series that a caller gives.

    Raises
    ------
    DataError
        The series have no names.
    """
    return list(_given(study, data))


def _given(study: Study, data: Data | None) -> dict[Key, Any]:
    """Return a caller's series by experiment and signal; a table may hold all signals of one."""
    if data is None:
        return {}
    if isinstance(data, pd.DataFrame) or not isinstance(data, Mapping | Curves):
        raise DataError(
            "data: series are given by experiment, such as {'tga_10K': table}; this is a "
            f"{type(data).__name__}"
        )
    found: dict[Key, Any] = {}
    for key, series in data.items():
        if isinstance(key, str) and key in study.experiments and isinstance(series, pd.DataFrame):
            found |= {(key, signal): series for signal in study.experiments[key].signals}
        else:
            found[key_of(study, key)] = series
    return found


def _from_table(
    signal: Signal, quantity: Quantity, path: Path, table: pd.DataFrame, timeless: bool
) -> Signal:
    """Return a signal that is read from a table, without the times that follow from its rate."""
    update: dict[str, Any] = {"file": str(path)}
    if quantity.column in table:  # as `read_data` returns it: no column has to be recognised
        tidy = quantity.tidy_keys()
        columns = {role: c for role, c in tidy["columns"].items() if c in table}
        if signal.uncertainty is not None:
            columns.pop("uncertainty", None)
        if timeless:
            columns.pop("time", None)
        units = {role: tidy["units"][role] for role in columns}
        update |= {"columns": columns, "units": units, "endothermic": "positive"}
        update |= {"sample_mass_kg": None, "sample_area_m2": None}
    return signal.model_copy(update=update)


def _with_signals(study: Study, signals: Mapping[Key, Signal]) -> Study:
    """Return a study that has these signals only."""
    of: dict[str, dict[str, Signal]] = {}
    for (name, label), signal in signals.items():
        of.setdefault(name, {})[label] = signal
    experiments = {
        name: study.experiments[name].model_copy(update={"signals": own})
        for name, own in of.items()
    }
    return study.model_copy(update={"experiments": experiments})


def _read(study: Study, labels: Mapping[str, str]) -> dict[Key, pd.DataFrame]:
    """Return all series of a study; messages name tables by their labels."""
    try:
        found = {}
        for key, (frame, about) in read_all(study).items():
            in_memory = study.experiments[key[0]].signals[key[1]].file in labels
            frame.attrs["notes"] = [indexed(n) if in_memory else n for n in about.notes]
            found[key] = frame
    except DataError as error:
        raise DataError(named_in_memory(str(error), labels)) from None
    lacking = {
        name
        for name, experiment in study.experiments.items()
        for signal in experiment.signals.values()
        if signal.file == SYNTHETIC
    }
    if lacking:
        own = {name: study.experiments[name] for name in study.experiments if name in lacking}
        found |= computed(study.model_copy(update={"experiments": own}))
    return found
