"""Curves and scores of the fitted and the published kinetics."""

from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from pyrofit.config import Study, kinetics_of
from pyrofit.cost.distances import root_mean_square
from pyrofit.estimate.targets import Measurements
from pyrofit.experiments.heated.simulate import request
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.results.files import Results, write_csv
from pyrofit.results.kinetics import FITTED, heats_shown, masses_shown
from pyrofit.simulate import simulate_tga
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Curves
from pyrofit.solver.outputs import FRACTION_RATE, MASS_FRACTION

Values = Mapping[str, float]


def write_curves(
    study: Study, results: Results, measurements: Measurements, fitted: Values
) -> None:
    """Write curves and scores of every set, at all experiments that are fitted or compared.

    ``curves.csv`` and ``scores.csv`` hold mass fractions; ``heats.csv`` and ``heat_scores.csv`` all
    other signals, where there are any.
    """
    curves: list[pd.DataFrame] = []
    scores: list[dict[str, Any]] = []
    for name, signal in masses_shown(study).items():
        frame = measurements[name, signal]
        measured = frame[MASS_FRACTION].to_numpy(float)
        for chosen, found in _simulated(study, name, signal, frame, fitted):
            mass = found.signals[MASS_FRACTION]
            columns = {MASS_FRACTION: mass, "mass_loss_rate_1_s": found.signals[FRACTION_RATE]}
            curves.append(_curve(study, name, signal, frame, columns).assign(set=chosen))
            about = _about(study, name, signal) | {"set": chosen}
            scores.append(about | {"rmse_mass_fraction": root_mean_square(mass - measured)})
    columns_of_curves = ["time_s", "temperature_K", MASS_FRACTION, "mass_loss_rate_1_s"]
    _write(results, "curves.csv", curves, [*columns_of_curves, "experiment", "set"])
    columns_of_scores = ["experiment", "heating_rate_K_min", "used_in_fit", "set"]
    frames = [pd.DataFrame(scores)] if scores else []
    _write(results, "scores.csv", frames, [*columns_of_scores, "rmse_mass_fraction"])
    if heats_shown(study):
        _write_heats(study, results, measurements, fitted)


def _write_heats(
    study: Study, results: Results, measurements: Measurements, fitted: Values
) -> None:
    curves = []
    scores = []
    for name, signal in heats_shown(study):
        frame = measurements[name, signal]
        quantity = study.experiments[name].quantity(signal)
        for chosen, found in _simulated(study, name, signal, frame, fitted):
            curve = found.signals[quantity.curve]
            labels = {"signal": signal, "set": chosen}
            curves.append(_curve(study, name, signal, frame, {"value": curve}).assign(**labels))
            error = root_mean_square(curve - frame[quantity.column].to_numpy(float))
            scores.append(_about(study, name, signal) | labels | {"rmse": error})
    write_csv(results.kinetics("heats.csv"), pd.concat(curves, ignore_index=True))
    write_csv(results.kinetics("heat_scores.csv"), pd.DataFrame(scores))


def _write(results: Results, file: str, frames: list[pd.DataFrame], columns: list[str]) -> None:
    """Write frames one behind the other, or no rows with these columns."""
    frame = pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=columns)
    write_csv(results.kinetics(file), frame)


def _simulated(
    study: Study, name: str, signal: str, frame: pd.DataFrame, fitted: Values
) -> Iterator[tuple[str, Curves]]:
    """Yield the curves of each set at the measured times of a signal."""
    values = {**study.fixed_values(), **fitted}
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    asked = request(experiment, signal, frame, _times(frame))
    for chosen in (FITTED, *kinetics_of(study).sets):
        material: Material = study.material_with(chosen)
        yield chosen, simulate_tga(experiment, material, values, asked, study.accuracy)


def _curve(
    study: Study, name: str, signal: str, frame: pd.DataFrame, columns: Mapping[str, FloatArray]
) -> pd.DataFrame:
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    temperature = request(experiment, signal, frame, _times(frame)).programme()[0]
    given = {"time_s": _times(frame), "temperature_K": temperature, **columns}
    return pd.DataFrame(given).assign(experiment=name)


def _about(study: Study, name: str, signal: str) -> dict[str, Any]:
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    cost = kinetics_of(study).cost
    return {
        "experiment": name,
        "heating_rate_K_min": experiment.heating_rate_K_min,
        "used_in_fit": any((t.experiment, t.signal) == (name, signal) for t in cost),
    }


def _times(frame: pd.DataFrame) -> FloatArray:
    return frame["time_s"].to_numpy(float)
