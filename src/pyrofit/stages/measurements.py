"""Step 1: measured series, read or computed, tidy and checked."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study, true_description
from pyrofit.data.closure import mass_closure
from pyrofit.data.noise import draw
from pyrofit.data.quantities import UNCERTAINTY_COLUMN, VALUE_COLUMN
from pyrofit.errors import DataError
from pyrofit.estimate.problem import Measurements
from pyrofit.files import Results, write_csv, write_json
from pyrofit.model.accuracy import Resolution
from pyrofit.model.experiment import Gasification, Noise, Signal, Tga
from pyrofit.model.material import Material
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Curves, Request
from pyrofit.stages import outcomes
from pyrofit.stages.closure import closure_lines
from pyrofit.stages.reading import SYNTHETIC, check_terms, read_all


def prepare(study: Study, results: Results) -> list[str]:
    """Read or compute every measured series and write it; return the mass closures as text.

    Raises
    ------
    DataError
        A file is missing or breaks a rule, or a synthetic measurement cannot be simulated.
    CostError
        A cost cannot be computed from its series.
    """
    series = read_all(study)
    about = {"source": SYNTHETIC, "sha256": ""}
    for key, frame in (computed(study) if study.is_synthetic else {}).items():
        series[key] = frame, about
    check_terms(study, {key: frame for key, (frame, _) in series.items()})
    summary: dict[str, Any] = {}
    for name, experiment in study.experiments.items():
        summary[name] = {}
        for quantity in experiment.signals:
            frame, about = series[name, quantity]
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
        (name, quantity): outcomes.series(results, name, quantity)
        for name, experiment in study.experiments.items()
        for quantity in experiment.signals
    }


def computed(study: Study) -> dict[tuple[str, str], pd.DataFrame]:
    """Return synthetic measurements: curves of the reference solver under the truth, with noise.

    Deterministic by the study's seed; noise is normal with the autocorrelation asked for, and its
    standard deviation is given as the uncertainty.

    Raises
    ------
    DataError
        The reference solver does not finish.
    """
    assert study.synthetic is not None
    values = study.true_values()
    series = {}
    material, experiments = true_description(study)
    resolution = study.synthetic.accuracy
    for name, experiment in experiments.items():
        wanted = {q: s for q, s in experiment.signals.items() if study.is_computed(name, q)}
        requests = _requests(experiment, wanted)
        curves = _simulate(experiment, material, values, requests, resolution)
        if not curves.status.finished:
            raise DataError(
                f"experiments.{name}: synthetic measurement failed: "
                f"{curves.status.explanation}; change synthetic.truth or synthetic.accuracy"
            )
        for quantity, request in requests.items():
            rng = np.random.default_rng(seed_for(study.seed, SYNTHETIC, name, quantity))
            clean = curves.signals[quantity]
            series[name, quantity] = _noisy(quantity, request, clean, wanted[quantity].noise, rng)
    return series


def _requests(experiment: Tga | Gasification, signals: dict[str, Signal]) -> dict[str, Request]:
    if isinstance(experiment, Gasification):
        return {
            q: Request(_times(s, experiment.duration_s), s.average_s) for q, s in signals.items()
        }
    first, last = experiment.start_temperature_K, experiment.end_temperature_K
    temperature = np.arange(first, last, signals["mass_fraction"].every)
    time = (temperature - first) / (experiment.heating_rate_K_min / 60.0)
    return {"mass_fraction": Request(time, temperature_K=temperature)}


def _simulate(
    experiment: Tga | Gasification,
    material: Material,
    values: dict[str, float],
    requests: dict[str, Request],
    resolution: Resolution,
) -> Curves:
    # Not above: loading its integrator takes a quarter of the time of a small job, and few need it.
    from pyrofit.solver.reference.gasification import reference_gasification
    from pyrofit.solver.reference.tga import reference_tga

    if isinstance(experiment, Tga):
        request = requests["mass_fraction"]
        return reference_tga(experiment, material, values, request, resolution)
    return reference_gasification(experiment, material, values, requests, resolution)


def _noisy(
    quantity: str, request: Request, clean: FloatArray, noise: Noise, rng: np.random.Generator
) -> pd.DataFrame:
    columns = {"time_s": request.time_s}
    if request.temperature_K is not None:
        columns["temperature_K"] = request.temperature_K
    columns[VALUE_COLUMN[quantity]] = clean + noise.sd * draw(noise.correlation(clean.size), rng)
    if noise.sd > 0.0:
        columns[UNCERTAINTY_COLUMN[quantity]] = np.full(clean.size, noise.sd)
    return pd.DataFrame(columns)


def _times(signal: Signal, duration: float) -> FloatArray:
    return np.arange(0.5 * signal.every, duration, signal.every)
