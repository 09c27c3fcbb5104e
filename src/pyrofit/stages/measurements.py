"""Step 1: measured series, read or computed, tidy and checked."""

import numpy as np
import pandas as pd

from pyrofit.analysis.closure import closure_lines
from pyrofit.config import Study, true_description
from pyrofit.data.noise import draw_noise
from pyrofit.errors import DataError
from pyrofit.experiments import kind_of
from pyrofit.model.signal import Noise
from pyrofit.quantities.base import Quantity
from pyrofit.results.files import Results, write_csv
from pyrofit.results.recorded import OfFile, OfSeries, write_summary
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Request
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
    about = OfFile(source=SYNTHETIC, sha256="")
    for key, frame in (computed(study) if study.is_synthetic else {}).items():
        series[key] = frame, about
    check_terms(study, {key: frame for key, (frame, _) in series.items()})
    summary: dict[str, dict[str, OfSeries]] = {}
    for name, experiment in study.experiments.items():
        summary[name] = {}
        for signal in experiment.signals:
            frame, about = series[name, signal]
            write_csv(results.measurement(name, signal), frame)
            summary[name][signal] = _described(about, frame, experiment.quantity(signal))
    write_summary(results, summary)
    return closure_lines(study, summary)


def _described(about: OfFile, frame: pd.DataFrame, quantity: Quantity) -> OfSeries:
    """Return the record of a series, with the mass and the heat that it released."""
    time, values = (frame[c].to_numpy(float) for c in ("time_s", quantity.column))
    of = {"released_kg_m2": quantity.released, "released_J_m2": quantity.heat}
    released = {key: total(time, values) for key, total in of.items() if total is not None}
    return OfSeries.model_validate(
        {**about.model_dump(exclude_unset=True), "points": len(frame), **released}
    )


def computed(study: Study, fast: bool = False) -> dict[tuple[str, str], pd.DataFrame]:
    """Return synthetic measurements: simulated curves under the truth, with noise.

    Deterministic by the study's seed; noise is normal with the autocorrelation asked for, and its
    standard deviation is given as the uncertainty.

    Parameters
    ----------
    study
        The study.
    fast
        Whether the production solver simulates, not the reference solver.

    Raises
    ------
    DataError
        A run does not finish.
    """
    assert study.synthetic is not None
    values = study.true_values()
    series = {}
    material, experiments = true_description(study)
    for name, experiment in experiments.items():
        kind = kind_of(experiment)
        wanted = [signal for signal in experiment.signals if study.is_computed(name, signal)]
        requests = kind.synthetic(experiment, wanted)
        if fast:
            [[curves]] = kind.simulate([experiment], material, values, [requests], study.accuracy)
        else:
            resolution = study.synthetic.accuracy
            curves = kind.reference(experiment, material, values, requests, resolution)
        if not curves.status.finished:
            raise DataError(
                f"experiments.{name}: synthetic measurement failed: "
                f"{curves.status.explanation}; change synthetic.truth or synthetic.accuracy"
            )
        for signal, request in requests.items():
            rng = np.random.default_rng(seed_for(study.seed, SYNTHETIC, name, signal))
            quantity, noise = experiment.quantity(signal), experiment.signals[signal].noise
            series[name, signal] = with_noise(quantity, request, curves.signals[signal], noise, rng)
    return series


def with_noise(
    quantity: Quantity, request: Request, clean: FloatArray, noise: Noise, rng: np.random.Generator
) -> pd.DataFrame:
    """Return a tidy series: a curve with drawn noise, and the noise's size as uncertainty."""
    columns = {"time_s": request.time_s}
    if request.temperature_K is not None:
        columns["temperature_K"] = request.temperature_K
    correlation = noise.correlation(clean.size)
    columns[quantity.column] = clean + noise.sd * draw_noise(correlation, rng)
    if noise.sd > 0.0:
        columns[quantity.uncertainty_column] = np.full(clean.size, noise.sd)
    return pd.DataFrame(columns)
