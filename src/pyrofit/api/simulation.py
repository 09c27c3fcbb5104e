"""Curves of a study's experiments for given values of its parameters."""

from collections.abc import Iterable, Mapping
from typing import overload

import pandas as pd

from pyrofit.api.choices import (
    Key,
    complete,
    experiments_of,
    si_columns,
    si_values,
    with_kinetics_of,
)
from pyrofit.api.curves import SIMULATED, Curves, with_unit_attributes
from pyrofit.api.ensemble import Ensemble, ensemble_of
from pyrofit.api.measurements import Data, given_keys, read_measured
from pyrofit.api.studies import Source, read_study
from pyrofit.config import Study
from pyrofit.config.resolve import diagnosed_material
from pyrofit.errors import DataError
from pyrofit.experiments import kind_of
from pyrofit.solver.curves import Request


@overload
def simulate(
    study: Source,
    values: pd.DataFrame,
    *,
    experiments: str | Iterable[str] | None = None,
    data: Data | None = None,
    kinetics: str | None = None,
) -> Ensemble: ...


@overload
def simulate(
    study: Source,
    values: Mapping[str, float] | None = None,
    *,
    experiments: str | Iterable[str] | None = None,
    data: Data | None = None,
    kinetics: str | None = None,
) -> Curves: ...


def simulate(
    study: Source,
    values: Mapping[str, float] | pd.DataFrame | None = None,
    *,
    experiments: str | Iterable[str] | None = None,
    data: Data | None = None,
    kinetics: str | None = None,
) -> Curves | Ensemble:
    """Simulate experiments of a study.

    Parameters
    ----------
    study
        A study, its file, or its keys.
    values
        Values of parameters, in the units of the study. Parameters with a ``value`` in the study
        may be left out. A table has a set a row and a parameter a column: its sets are simulated
        side by side.
    experiments
        Names of experiments, by default all.
    data
        Series at whose times is simulated, such as those of `read_data`. By default times are
        spaced as the key ``every`` of a signal says, from the start to the end of the experiment.
    kinetics
        'described', 'fitted' or a published set of the study; by default those that its diagnosis
        and its fits start from.

    Returns
    -------
    Curves or Ensemble
        The curves of one set, or of all sets of a table, of the shape (sets, points) each. Sets
        whose run does not finish are NaN there, and listed in ``failed``.

    Raises
    ------
    StudyError
        A name is not known, or a parameter has no value.
    DataError
        A simulation of the only set does not finish.

    Examples
    --------
    >>> import pyrofit as pf
    >>> pf.simulate("config/smoke.yaml", {"T_q": 600})
    Traceback (most recent call last):
    pyrofit.errors.StudyError: study 'smoke' has no parameter 'T_q'. Did you mean 'T_p'? Known: ...
    """
    study = with_kinetics_of(read_study(study), kinetics)
    names = experiments_of(study, experiments)
    if data is None:
        requests = {
            name: kind_of(study.experiments[name]).synthetic(
                study.experiments[name], list(study.experiments[name].signals)
            )
            for name in names
        }
    else:
        keys = [key for key in given_keys(study, data) if key[0] in names]
        requests = at_times(study, read_measured(study, keys, data))
        names = list(requests)
    if isinstance(values, pd.DataFrame):
        columns = si_columns(study, values)
        of_first = complete(study, {n: float(c[0]) for n, c in columns.items()}, names)
        return ensemble_of(study, values, {**of_first, **columns}, requests)
    every = complete(study, si_values(study, {} if values is None else values), names)
    return Curves(study, simulated(study, every, requests), SIMULATED)


def at_times(study: Study, series: Mapping[Key, pd.DataFrame]) -> dict[str, dict[str, Request]]:
    """Return requests at the times of measured series, by experiment and signal."""
    requests: dict[str, dict[str, Request]] = {}
    for (name, signal), frame in series.items():
        experiment = study.experiments[name]
        time = frame["time_s"].to_numpy(float)
        request = kind_of(experiment).request(experiment, signal, frame, time)
        requests.setdefault(name, {})[signal] = request
    return requests


def simulated(
    study: Study, values: Mapping[str, float], requests: Mapping[str, Mapping[str, Request]]
) -> dict[Key, pd.DataFrame]:
    """Return simulated series for SI values, by experiment and signal.

    Raises
    ------
    DataError
        A simulation does not finish.
    """
    material = diagnosed_material(study)
    found = {}
    for name, asked in requests.items():
        experiment = study.experiments[name]
        simulate_kind = kind_of(experiment).simulate
        [[run]] = simulate_kind([experiment], material, values, [asked], study.accuracy)
        if not run.status.finished:
            raise DataError(
                f"experiments.{name}: the simulation failed: {run.status.explanation}; change the "
                "values of the parameters"
            )
        for signal, request in asked.items():
            quantity = experiment.quantity(signal)
            columns = {"time_s": request.time_s}
            if quantity.against_temperature:
                columns["temperature_K"] = request.programme()[0]
            columns[quantity.column] = run.signals[signal]
            found[name, signal] = with_unit_attributes(pd.DataFrame(columns), quantity)
    return found
