"""Step 1: measured series, read or computed, tidy and checked."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.data.closure import mass_closure
from pyrofit.data.fetch import locate
from pyrofit.data.quantities import UNCERTAINTY_COLUMN, VALUE_COLUMN
from pyrofit.data.series import Measurement, SeriesSpec, read_series
from pyrofit.errors import DataError
from pyrofit.estimate.problem import Measurements
from pyrofit.estimate.sceua import seed_for
from pyrofit.files import Results, read_csv, write_csv, write_json
from pyrofit.model.experiment import Gasification, Signal, Tga
from pyrofit.simulate import simulate_gasification, simulate_tga
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Request
from pyrofit.stages.closure import closure_lines

SYNTHETIC = "synthetic"
MACFP = "macfp:"


def prepare(study: Study, results: Results) -> list[str]:
    """Read or compute every measured series and write it; return the mass closures as text.

    Raises
    ------
    DataError
        A file is missing or breaks a rule, or a synthetic measurement cannot be simulated.
    """
    truth = computed(study) if study.is_synthetic else {}
    summary: dict[str, Any] = {}
    for name, experiment in study.experiments.items():
        summary[name] = {}
        for quantity, signal in experiment.signals.items():
            if signal.file == SYNTHETIC:
                frame, about = truth[name, quantity], {"source": SYNTHETIC, "sha256": ""}
            else:
                frame, about = _read(quantity, signal)
            write_csv(results.measurement(name, quantity), frame)
            summary[name][quantity] = {**about, "points": len(frame)}
            if quantity == "mlr":
                mass = mass_closure(frame, 1.0).released_kg_m2
                summary[name][quantity]["released_kg_m2"] = mass
    write_json(results.measurements_summary, {"signals": summary})
    return closure_lines(study, summary)


def load(study: Study, results: Results) -> Measurements:
    """Return the series that `prepare` wrote, by (experiment, signal)."""
    return {
        (name, quantity): read_csv(results.measurement(name, quantity))
        for name, experiment in study.experiments.items()
        for quantity in experiment.signals
    }


def _read(quantity: str, signal: Signal) -> tuple[pd.DataFrame, dict[str, Any]]:
    found: Measurement = read_series(
        SeriesSpec(
            quantity=quantity,
            path=_locate(signal.file),
            columns=signal.columns,
            units=signal.units,
            uncertainty=signal.uncertainty,
            uncertainty_meaning=signal.uncertainty_meaning,
            sample_mass_kg=signal.sample_mass_kg,
            sample_area_m2=signal.sample_area_m2,
        )
    )
    frame = found.frame
    if signal.until_K is not None:
        frame = frame[frame["temperature_K"] <= signal.until_K]
    if signal.until_s is not None:
        frame = frame[frame["time_s"] <= signal.until_s]
    if len(frame) < 3:
        raise DataError(f"{found.source}: until_K or until_s leaves {len(frame)} points; raise it")
    about = {
        "source": signal.file,
        "sha256": found.sha256,
        "uncertainty": found.uncertainty_meaning,
        "notes": list(found.notes),
    }
    return frame, about


def _locate(file: str) -> Path:
    return locate(file.removeprefix(MACFP)) if file.startswith(MACFP) else Path(file)


def computed(study: Study) -> dict[tuple[str, str], pd.DataFrame]:
    """Return synthetic measurements: the solver's curves on its finer grid, with noise.

    Deterministic by the study's seed; noise is normal and independent between points, and its
    standard deviation is given as the uncertainty.
    """
    assert study.synthetic is not None
    truth = {n: v * study.parameters[n].factor for n, v in study.synthetic.truth.items()}
    values = {**study.fixed_values(), **truth}
    series = {}
    for name, experiment in study.experiments.items():
        wanted = {q: s for q, s in experiment.signals.items() if s.file == SYNTHETIC}
        for quantity, frame in _compute(study, experiment, wanted, values).items():
            signal = wanted[quantity]
            rng = np.random.default_rng(seed_for(study.seed, SYNTHETIC, name, quantity))
            column = VALUE_COLUMN[quantity]
            frame[column] += signal.noise * rng.standard_normal(len(frame))
            if signal.noise > 0.0:
                frame[UNCERTAINTY_COLUMN[quantity]] = signal.noise
            series[name, quantity] = frame
    return series


def _compute(
    study: Study,
    experiment: Tga | Gasification,
    signals: dict[str, Signal],
    values: dict[str, float],
) -> dict[str, pd.DataFrame]:
    assert study.synthetic is not None
    accuracy = study.synthetic.accuracy
    if not signals:
        return {}
    if isinstance(experiment, Tga):
        first, last = experiment.start_temperature_K, experiment.end_temperature_K
        temperature = np.arange(first, last, signals["mass_fraction"].every)
        time = (temperature - first) / (experiment.heating_rate_K_min / 60.0)
        request = Request(time, temperature_K=temperature)
        curves = simulate_tga(experiment, study.material, values, request, accuracy)
        mass = curves.signals["mass_fraction"]
        columns = {"time_s": time, "temperature_K": temperature, "mass_fraction": mass}
        return {"mass_fraction": pd.DataFrame(columns)}
    requests = {
        q: Request(_times(s, experiment.duration_s), s.average_s) for q, s in signals.items()
    }
    curves = simulate_gasification(experiment, study.material, values, requests, accuracy)
    if not curves.status.finished:
        raise DataError(
            f"synthetic measurement failed: {curves.status.explanation}; change synthetic.truth"
        )
    return {
        q: pd.DataFrame({"time_s": r.time_s, VALUE_COLUMN[q]: curves.signals[q]})
        for q, r in requests.items()
    }


def _times(signal: Signal, duration: float) -> FloatArray:
    return np.arange(0.5 * signal.every, duration, signal.every)
