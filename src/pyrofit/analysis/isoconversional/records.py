"""The records of mass of a study, and the model's curves at their times, as conversion."""

from collections.abc import Mapping

import pandas as pd

from pyrofit.analysis.isoconversional.curve import Curve, curve_of
from pyrofit.config import Study
from pyrofit.experiments.heated.simulate import programme, request
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_tga
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.outputs import MASS_FRACTION

Measured = Mapping[tuple[str, str], pd.DataFrame]
FEWEST = 2
"""Heating programmes that the analysis needs."""
LEAST_LOST = 0.02
"""Mass lost over the initial mass below which a record shows no reaction."""


def masses(study: Study) -> dict[str, str]:
    """Return the signal of mass of each heated sample that has one, by experiment."""
    found: dict[str, str] = {}
    for name, experiment in study.experiments.items():
        if isinstance(experiment, HeatedExperiment):
            for signal in experiment.signals:
                if experiment.quantity(signal).curve == MASS_FRACTION:
                    found.setdefault(name, signal)
    return found


def conditions(study: Study) -> dict[str, str]:
    """Return the heating programme of each heated sample that has a mass, in words."""
    return {name: _condition(_heated(study, name)) for name in masses(study)}


def applies(study: Study) -> bool:
    """Tell whether a study has masses of two heating programmes."""
    return len(set(conditions(study).values())) >= FEWEST


def measured_curves(study: Study, measurements: Measured) -> list[Curve]:
    """Return the measured masses of a study as conversion."""
    at_rate = {
        name: _curve(study, name, frame, frame[MASS_FRACTION].to_numpy(float))
        for name, frame in _frames(study, measurements).items()
    }
    return _with_common_end(study, at_rate)


def simulated_curves(
    study: Study, material: Material, values: Mapping[str, float], measurements: Measured
) -> list[Curve]:
    """Return the masses of a model at the times of the measured ones; none if a run fails.

    Parameters
    ----------
    study, material
        The experiments, and the material with its kinetics.
    values
        All parameters, SI units.
    measurements
        Measured series by experiment and signal.
    """
    found = {}
    for name, frame in _frames(study, measurements).items():
        experiment = _heated(study, name)
        asked = request(experiment, masses(study)[name], frame, frame["time_s"].to_numpy(float))
        run = simulate_tga(experiment, material, values, asked, study.accuracy)
        if not run.status.finished:
            return []
        found[name] = _curve(study, name, frame, run.signals[MASS_FRACTION])
    return _with_common_end(study, found)


def _frames(study: Study, measurements: Measured) -> dict[str, pd.DataFrame]:
    return {name: measurements[name, signal] for name, signal in masses(study).items()}


def _heated(study: Study, name: str) -> HeatedExperiment:
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    return experiment


def _condition(experiment: HeatedExperiment) -> str:
    if experiment.set_point_K is not None:
        return f"{experiment.set_point_K:g} K"
    return f"{experiment.heating_rate_K_min:g} K/min"


def _curve(study: Study, name: str, frame: pd.DataFrame, mass: FloatArray) -> Curve:
    experiment = _heated(study, name)
    time = frame["time_s"].to_numpy(float)
    temperature = programme(experiment, frame, time)
    rate = None if experiment.is_isothermal else experiment.heating_rate_K_min
    return curve_of(name, _condition(experiment), rate, time, temperature, mass)


def _with_common_end(study: Study, found: Mapping[str, Curve]) -> list[Curve]:
    """Return curves, those of holds with the last mass of the heated ones.

    A hold may end before the conversion is complete. Without a heated record, all holds end at the
    largest loss among them.
    """
    lost = [c.lost for c in found.values() if c.rate_K_min is not None]
    whole = sum(lost) / len(lost) if lost else max((c.lost for c in found.values()), default=0.0)
    return [
        curve if curve.rate_K_min is not None or whole <= 0.0 else curve.scaled(whole)
        for curve in found.values()
    ]
