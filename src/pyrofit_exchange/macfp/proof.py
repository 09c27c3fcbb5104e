"""Proof of calibration: simulations of the experiments that a set was fitted to."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.cost.distances import root_mean_square
from pyrofit.experiments import kind_of
from pyrofit.quantities.base import Quantity
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.measurements import computed
from pyrofit.stages.reading import read_all
from pyrofit_exchange.macfp.predict import AREA_M2
from pyrofit_exchange.sets import ParameterSet

SAMPLE_MG = 5.0
"""Mass of a heated sample where the study does not give it."""


class Proof(NamedTuple):
    """A calibrated signal.

    Parameters
    ----------
    experiment, signal
        Which it is.
    file
        Name of its file.
    rms, mean
        Root mean square of the difference, and mean of the measured values, in `unit`.
    unit
        The unit shown.
    """

    experiment: str
    signal: str
    file: str
    rms: float
    mean: float
    unit: str


def calibration_signals(study: Study) -> dict[str, list[str]]:
    """Return the signals by experiment that the kinetics and the first cost use."""
    used: dict[str, list[str]] = {}
    first = next(iter(study.imp.costs.values()))
    kinetics = study.kinetics.cost if study.kinetics is not None else ()
    for term in (*kinetics, *first):
        signals = used.setdefault(term.experiment, [])
        if term.signal not in signals:
            signals.append(term.signal)
    return used


def write_proofs(study: Study, chosen: ParameterSet, folder: Path, institute: str) -> list[Proof]:
    """Write a file for each calibrated signal, in the columns of the measured ones."""
    folder.mkdir(parents=True, exist_ok=True)
    frames = {key: read[0] for key, read in read_all(study).items()}
    if study.is_synthetic:
        frames |= computed(study)
    proofs = []
    for name, signals in calibration_signals(study).items():
        experiment = study.experiments[name]
        kind = kind_of(experiment)
        asked = {}
        for signal in signals:
            frame = frames[name, signal]
            asked[signal] = kind.request(experiment, signal, frame, frame["time_s"].to_numpy(float))
        run = kind.simulate([experiment], chosen.material, chosen.values, [asked], study.accuracy)[
            0
        ][0]
        for signal in signals:
            quantity, frame = experiment.quantity(signal), frames[name, signal]
            curve = np.asarray(run.signals[signal], np.float64)
            file = f"{institute}_{name}_{signal}.csv"
            written = _columns(quantity, frame, curve)
            pd.DataFrame(written).to_csv(folder / file, index=False, float_format="%.6g")
            proofs.append(_proof(name, signal, file, quantity, frame, curve))
    return proofs


def _columns(
    quantity: Quantity, frame: pd.DataFrame, curve: FloatArray
) -> Mapping[str, FloatArray]:
    """Return the columns of a file of the data base."""
    columns = {"Time (s)": frame["time_s"].to_numpy(float)}
    if quantity.against_temperature:
        columns["Temperature (K)"] = frame["temperature_K"].to_numpy(float)
    if quantity.scales[0] == "fraction":
        return columns | {"Mass (mg)": SAMPLE_MG * curve}
    if quantity.scales[0] == "mass per area":
        return columns | {"Mass (g)": 1e3 * AREA_M2 * curve}
    if quantity.is_temperature:
        return columns | {f"{quantity.title.capitalize()} (K)": curve}
    shown = quantity.shown
    unit = shown.unit.replace("²", "2").replace("g/(m2 s)", "g/m2/s")
    return columns | {f"{quantity.symbol} ({unit})": shown.factor * curve}


def _proof(
    name: str,
    signal: str,
    file: str,
    quantity: Quantity,
    frame: pd.DataFrame,
    curve: FloatArray,
) -> Proof:
    measured = frame[quantity.column].to_numpy(float)
    factor = 1.0 if quantity.is_temperature else quantity.shown.factor
    unit = "K" if quantity.is_temperature else quantity.shown.unit
    rms = root_mean_square(curve - measured)
    return Proof(name, signal, file, factor * rms, factor * float(measured.mean()), unit)
