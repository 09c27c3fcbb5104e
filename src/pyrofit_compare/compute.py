"""Compare predictions of a study, and those of others, with further tests."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.experiments import kind_of
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit.results.files import Results
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.reading import read_all
from pyrofit_compare.apparatus import Apparatus
from pyrofit_compare.given import exposure, group_of, read_tests, thickness
from pyrofit_compare.others import PredictedCurve, matching, read_predictions
from pyrofit_compare.score import Mean, mean_at_times, mean_of, nrms
from pyrofit_exchange.sets import parameter_set

OURS, REPEATS = "this study", "scatter of repeats"
LEAST_K = 200.0
"""Simulated temperatures below this are no temperatures of a test."""
Record = tuple[FloatArray, FloatArray]
Key = tuple[str, str]
Series = Mapping[Key, pd.DataFrame]


@dataclass(frozen=True, eq=False)
class ComparedWith:
    """Scores and curves.

    Parameters
    ----------
    study
        The study with the further tests as its experiments.
    label
        Parameter set of the predictions.
    scores
        test, signal, who, nrms, this_study (its error at the times of who), covered (part of the
        measured times), repeats (their number).
    means
        Mean of the repeats by test and signal.
    curves
        By test and signal and who: the mean prediction at the times of the mean.
    assumed
        Assumptions, in words.
    left
        Which files and values are left out, and why.
    apparatus
        Numbers of the apparatus that its inert runs tell.
    """

    study: Study
    label: str
    scores: pd.DataFrame
    means: Mapping[Key, Mean]
    curves: Mapping[Key, Mapping[str, FloatArray]]
    assumed: tuple[str, ...]
    left: tuple[str, ...]
    apparatus: Apparatus


def compute_comparison(
    study: Study,
    results: Results,
    tests: Path,
    predictions: Sequence[Path] = (),
    label: str = "",
    beside: Path | None = None,
) -> ComparedWith:
    """Predict further tests with a set of a study, and score it as MaCFP does.

    Raises
    ------
    StudyError
        The tests break a rule, or the study has no such set.
    DataError
        A measured or predicted file breaks a rule, or a simulation does not finish.
    """
    chosen = parameter_set(study, results, label, beside or Path())
    posed = study.model_copy(update={"material": chosen.material})
    given = read_tests(tests, posed, chosen.values)
    material = given.study.material
    values = {**given.study.fixed_values(), **chosen.values, **given.apparatus.values}
    others = read_predictions(predictions, given.area_m2)
    series = measured_series(given.study, tests)
    measured, ours, left = both_records(given.study, series, tests, material, values)
    means: dict[Key, Mean] = {}
    found: dict[Key, dict[str, FloatArray]] = {}
    rows: list[dict[str, object]] = []
    for key, records in measured.items():
        try:
            means[key] = mean_of(records)
        except DataError as error:
            raise DataError(f"{tests}: experiments.{key[0]}: {key[1]}: {error}.") from None
        by_who = {OURS: ours[key], **_others(given.study, values, key, others.curves)}
        found[key] = {who: mean_at_times(means[key], curves) for who, curves in by_who.items()}
        rows += _scored(key, means[key], found[key])
    counts = {key: mean.repeats for key, mean in means.items()}
    scores = pd.DataFrame(rows)
    scores["repeats"] = [
        counts[t, s] for t, s in zip(scores["test"], scores["signal"], strict=True)
    ]
    return ComparedWith(
        given.study,
        chosen.label,
        scores,
        means,
        found,
        given.assumed,
        (*left, *others.left),
        given.apparatus,
    )


def _scored(key: Key, mean: Mean, curves: Mapping[str, FloatArray]) -> list[dict[str, object]]:
    """Return the scores of a signal: scatter of repeats, this study, others."""
    about = {"test": key[0], "signal": key[1]}
    nan = float("nan")
    floor = {"who": REPEATS, "nrms": mean.floor, "this_study": nan, "covered": 1.0}
    rows: list[dict[str, object]] = [about | floor]
    for who, curve in curves.items():
        kept = np.isfinite(curve)
        own = np.where(kept, curves[OURS], nan)
        errors = {"nrms": nrms(mean, curve), "this_study": nrms(mean, own)}
        rows.append({**about, "who": who, **errors, "covered": float(kept.mean())})
    return rows


def measured_series(study: Study, place: Path | str) -> Series:
    """Return the measured series of a study that is described at a place, by experiment and signal.

    Raises
    ------
    DataError
        A file breaks a rule.
    """
    try:
        return {key: frame for key, (frame, _) in read_all(study).items()}
    except DataError as error:
        raise DataError(f"{place}: {error}") from None


def both_records(
    study: Study, series: Series, place: Path | str, material: Material, values: Mapping[str, float]
) -> tuple[dict[Key, list[Record]], dict[Key, list[Record]], list[str]]:
    """Return measured and simulated records of the repeats by test and signal, and remarks.

    Raises
    ------
    DataError
        A simulation does not finish.
    """
    measured: dict[Key, list[Record]] = {}
    ours: dict[Key, list[Record]] = {}
    left: list[str] = []
    for name, experiment in study.experiments.items():
        kind = kind_of(experiment)
        frames = {signal: series[name, signal] for signal in experiment.signals}
        asked = {
            signal: kind.request(experiment, signal, frame, frame["time_s"].to_numpy(float))
            for signal, frame in frames.items()
        }
        [[run]] = kind.simulate([experiment], material, values, [asked], study.accuracy)
        if not run.status.finished:
            raise DataError(
                f"{place}: experiments.{name}: the simulation failed: {run.status.explanation}"
            )
        for signal, frame in frames.items():
            key = group_of(study, name), signal
            value = frame[experiment.quantity(signal).column].to_numpy(float)
            time = frame["time_s"].to_numpy(float)
            measured.setdefault(key, []).append((time, value))
            simulated = np.array(run.signals[signal])
            if experiment.quantity(signal).is_temperature and (simulated < LEAST_K).any():
                bad = simulated < LEAST_K
                simulated[bad] = np.nan
                left.append(
                    f"{name}, {signal}: {bad.sum()} simulated values below {LEAST_K:g} K are left "
                    f"out, from {time[bad][0]:g} s: the solver has no valid temperature there."
                )
            ours.setdefault(key, []).append((time, simulated))
    return measured, ours, left


def _others(
    study: Study, values: Mapping[str, float], key: Key, others: Sequence[PredictedCurve]
) -> dict[str, list[Record]]:
    """Return the curves of others for a signal, from the start of the exposure."""
    name = next(n for n in study.experiments if group_of(study, n) == key[0])
    experiment = study.experiments[name]
    if not others or not isinstance(experiment, SlabExperiment):
        return {}
    flux, start = exposure(experiment, values)
    if not flux > 0.0:
        return {}
    found: dict[str, list[Record]] = {}
    for curve in matching(others, flux, thickness(experiment), experiment.quantity(key[1]).name):
        found.setdefault(curve.who, []).append((curve.time_s + start, curve.value))
    return found
