"""Whether a measured series agrees with the experiment as it is described."""

import contextlib

import numpy as np
import pandas as pd

from pyrofit.analysis.closure import described_mass
from pyrofit.config import Study
from pyrofit.data.heating import usual_rise
from pyrofit.data.suspect import LOOK
from pyrofit.errors import DataError
from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.slab import SlabExperiment
from pyrofit.solver.outputs import MASS

OTHER_RATE = 0.2
"""Share by which a measured heating rate may differ from the one given."""
OTHER_START_K = 3.0
"""Difference from the described initial temperature [K] above which there is a note."""
OTHER_HOLD_K = 25.0
"""Difference from the set point that only an error explains."""
OTHER_MASS, FIRST = 0.05, 5
"""Share by which the median of the first points may differ from the described mass."""


def disagreements(
    study: Study, name: str, signal: str, frame: pd.DataFrame, source: str
) -> list[str]:
    """Return notes on a series, SI units, whose start differs from the described one.

    Raises
    ------
    DataError
        With ``source``, the file: the sample was heated at another rate than the experiment gives.
    """
    experiment = study.experiments[name]
    if isinstance(experiment, HeatedExperiment) and experiment.set_point_K is not None:
        return _hold_notes(experiment.set_point_K, frame, source)
    if isinstance(experiment, HeatedExperiment):
        time, temperature = frame["time_s"].to_numpy(), frame["temperature_K"].to_numpy()
        found, given = 60.0 * usual_rise(time, temperature), experiment.heating_rate_K_min
        if found == 0.0:
            raise DataError(
                f"{source}: the temperature does not rise over most of the record, as where a "
                "sample is heated and cooled in turn. Give a file of one heating"
            )
        if abs(found - given) > OTHER_RATE * given:
            raise DataError(
                f"{source}: the temperature rises by {found:.3g} K/min, the experiment's "
                f"heating_rate_K_min is {given:g}; correct it, or the unit of the time column"
            )
    elif isinstance(experiment, SlabExperiment):
        return _start_notes(study, experiment, signal, frame)
    return []


def _hold_notes(set_point_K: float, frame: pd.DataFrame, source: str) -> list[str]:
    """Compare the temperature that is held with the set point.

    Raises
    ------
    DataError
        They differ by more than `OTHER_HOLD_K`.
    """
    temperature = frame["temperature_K"].to_numpy()
    held = float(np.median(temperature[3 * temperature.size // 4 :]))
    if abs(held - set_point_K) > OTHER_HOLD_K:
        raise DataError(
            f"{source}: the last quarter of the record is at {held:.1f} K, set_point_K of the "
            f"experiment is {set_point_K:g}; correct it, or the unit of the temperatures"
        )
    return [] if abs(held - set_point_K) < 2.0 else [f"held at {held:.1f} K"]


def _start_notes(
    study: Study, experiment: SlabExperiment, signal: str, frame: pd.DataFrame
) -> list[str]:
    """Note a temperature or a mass that starts at another value than the described one."""
    quantity = experiment.quantity(signal)
    record = frame[quantity.column].to_numpy()
    with contextlib.suppress(KeyError):  # the described value is to be estimated
        if quantity.is_temperature:
            return _temperature_notes(study, experiment, float(record[0]))
        if quantity.curve == MASS:
            offset = value_of(experiment.signals[signal].offset, study.fixed_values())
            return _mass_notes(study, experiment, float(np.median(record[:FIRST])) - offset)
    return []


def _temperature_notes(study: Study, experiment: SlabExperiment, start: float) -> list[str]:
    described = value_of(experiment.sample.initial_temperature_K, study.fixed_values())
    if abs(start - described) <= OTHER_START_K:
        return []
    return [f"starts at {start:.1f} K, initial_temperature_K of the sample is {described:.1f}"]


def _limit_notes(study: Study, experiment: SlabExperiment, start: float) -> list[str]:
    """Note a first mass [kg/m2] that no density within the limits gives.

    Densities and thicknesses are at both their limits, shares of a composition in the middle.
    """
    layers = [layer.composed(study.material.composition) for layer in experiment.sample.layers]
    shares = {share for composition in layers for share in composition.values()}
    free = {name: p.bounds_si for name, p in study.parameters.items() if p.value is None}
    lower, upper = (
        described_mass(
            study,
            experiment,
            study.fixed_values()
            | {n: 0.5 * (a + b) if n in shares else (a, b)[at] for n, (a, b) in free.items()},
        )
        for at in (0, 1)
    )
    if (1.0 - OTHER_MASS) * lower <= start <= (1.0 + OTHER_MASS) * upper:
        return []
    return [
        f"{LOOK}the first mass is {start:.3f} kg/m2, the limits of density and thickness allow "
        f"{lower:.3f} to {upper:.3f}: correct thickness, area or `offset`, or widen the limits"
    ]


def _mass_notes(study: Study, experiment: SlabExperiment, start: float) -> list[str]:
    values = study.fixed_values()
    try:
        described = described_mass(study, experiment, values)
    except KeyError:
        return _limit_notes(study, experiment, start)
    if abs(start - described) <= OTHER_MASS * described:
        return []
    return [
        f"starts at {start:.3f} kg/m2, the sample as described has {described:.3f}; "
        "if the load cell shows more than the sample, give `offset`"
    ]
