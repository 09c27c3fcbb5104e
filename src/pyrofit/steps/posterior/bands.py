"""Every experiment predicted by draws from the posterior, with model discrepancy."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from pyrofit.config import Study, TermSpec
from pyrofit.config.check.unmeasured import unmeasured
from pyrofit.errors import DataError
from pyrofit.estimate.bands import band, carried, measured
from pyrofit.estimate.channel_noise import noise_of
from pyrofit.estimate.discrepancy import Discrepancy
from pyrofit.estimate.pose import of_imp, pose
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.sampled import Sampled, spread
from pyrofit.estimate.targets import Measurements
from pyrofit.quantities import known_quantities
from pyrofit.quantities.base import Quantity
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.unmeasured import predict_unmeasured
from pyrofit.steps.posterior.record import OfBand, Role

DRAWS = 400
"""Draws that make a band: ten of them lie beyond each of its ends."""
AT_ONCE = 100
"""Sets that are simulated side by side."""
_ALONE = ("parameters_low", "parameters_median", "parameters_high")


@dataclass(frozen=True, eq=False)
class Predicted:
    """A signal predicted by draws: curves of shape (sets, points), SI units."""

    experiment: str
    signal: str
    role: Role
    quantity: Quantity
    time_s: FloatArray
    curves: FloatArray
    lacking: FloatArray | None
    """Drawn discrepancies; None where no fitted experiment tells them."""
    value: FloatArray | None = None
    """The measured series."""
    sd: FloatArray | None = None
    """Standard deviation of its noise."""


def predict_with_bands(
    study: Study, found: Sampled, measurements: Measurements, fixed: Mapping[str, float]
) -> tuple[pd.DataFrame, list[OfBand]]:
    """Return the bands of all signals over time, and the numbers that describe them.

    Raises
    ------
    DataError
        None of the draws can be simulated at the predicted experiments.
    """
    X = found.likelihood.values(spread(found.drawn, DRAWS))
    rng = np.random.default_rng(seed_for(study.seed, "posterior", "bands"))
    signals = _of_measured(study, found, X, measurements, fixed, rng)
    signals += _of_unmeasured(study, found, X, fixed, rng)
    frames, numbers = zip(*(_bands(one, rng) for one in signals), strict=True)
    return pd.concat(frames, ignore_index=True), list(numbers)


def _of_measured(
    study: Study,
    found: Sampled,
    X: FloatArray,
    measurements: Measurements,
    fixed: Mapping[str, float],
    rng: np.random.Generator,
) -> list[Predicted]:
    fitted = list(study.imp.channels)
    pairs = {(c.experiment, c.signal) for c in fitted}
    more = [
        TermSpec(experiment=name, signal=signal, kind="RMSE")
        for name in study.validation.experiments
        for signal in study.experiments[name].signals
        if (name, signal) not in pairs
    ]
    problem = pose(study, of_imp(study, [*fitted, *more]), measurements, fixed)
    models = _simulated(problem, X)
    signals = []
    for k, (name, signal, _) in enumerate(problem.picks):
        target = problem.cost.terms[k][1].target
        curves = np.array([model[k] for model in models])
        quantity = study.experiments[name].quantity(signal)
        if k < len(fitted):
            noise = found.noise_alone.noise[k]
            best = found.likelihood.split(found.curves)[k]
            covariance = found.discrepancies[k].covariance(target.time_s, best)
            lacking: FloatArray | None = measured(covariance, noise, target.value - curves, rng)
            sd: FloatArray | None = noise.total_sd
            role: Role = "fitted"
        else:
            lacking = _carried(study, found, quantity, target.time_s, curves, rng)
            sd, role = _noise_sd(problem, k), "held out"
        signals.append(
            Predicted(
                name, signal, role, quantity, target.time_s, curves, lacking, target.value, sd
            )
        )
    return signals


def _simulated(problem: Problem, X: FloatArray) -> list[list[FloatArray]]:
    outcomes = [
        outcome
        for first in range(0, len(X), AT_ONCE)
        for outcome in problem.simulate_all(X[first : first + AT_ONCE])
    ]
    models = [models for status, models in outcomes if status.finished]
    if not models:
        raise DataError("no draw of the posterior can be predicted; check the experiments")
    return models


def _noise_sd(problem: Problem, k: int) -> FloatArray | None:
    try:
        return noise_of(problem, k).total_sd
    except DataError:
        return None  # too few points to tell


def _of_unmeasured(
    study: Study,
    found: Sampled,
    X: FloatArray,
    fixed: Mapping[str, float],
    rng: np.random.Generator,
) -> list[Predicted]:
    if not unmeasured(study):
        return []
    labels = {f"draw {i}": None for i in range(len(X))}
    values = {**fixed, **dict(zip(study.imp.estimate, X.T, strict=True))}
    material = study.material_with(study.imp.kinetics)
    frame = predict_unmeasured(study, material, values, labels)
    signals = []
    for (name, signal), part in frame.groupby(["experiment", "signal"], sort=False):
        quantity = known_quantities()[str(signal)]
        time = part["time_s"].to_numpy(float).reshape(len(X), -1)[0]
        curves = part["simulated"].to_numpy(float).reshape(len(X), -1)
        lacking = _carried(study, found, quantity, time, curves, rng)
        role: Role = "not measured"
        signals.append(Predicted(str(name), str(signal), role, quantity, time, curves, lacking))
    return signals


def _carried(
    study: Study,
    found: Sampled,
    quantity: Quantity,
    time: FloatArray,
    curves: FloatArray,
    rng: np.random.Generator,
) -> FloatArray | None:
    """Draw discrepancies of the sizes that the fitted experiments show in the same quantity."""
    known: list[Discrepancy] = [
        of
        for (name, signal, _), of in zip(
            found.likelihood.problem.picks, found.discrepancies, strict=True
        )
        if study.experiments[name].quantity(signal).name == quantity.name
    ]
    if not known:
        return None
    return carried(known).carried_to(time, curves, rng) - curves


def _bands(of: Predicted, rng: np.random.Generator) -> tuple[pd.DataFrame, OfBand]:
    """Return the bands over time, the solver's error added, and their widths."""
    whole = of.curves if of.lacking is None else of.curves + of.lacking
    error = of.quantity.solver_error * float(np.ptp(np.median(of.curves, axis=0)))
    edges = error * np.array([-1.0, 0.0, 1.0])[:, None]
    wide, narrow = band(whole) + edges, band(of.curves) + edges
    size = max(float(np.ptp(wide[1])), 1e-300)
    frame = pd.DataFrame(
        {
            "experiment": of.experiment,
            "signal": of.signal,
            "role": of.role,
            "time_s": of.time_s,
            "measured": np.nan if of.value is None else of.value,
            **dict(zip(("low", "median", "high"), wide, strict=True)),
            **dict(zip(_ALONE, narrow, strict=True)),
        }
    )
    numbers = OfBand(
        experiment=of.experiment,
        signal=of.signal,
        role=of.role,
        width=float(np.mean(wide[2] - wide[0])) / size,
        parameters_width=float(np.mean(narrow[2] - narrow[0])) / size,
        lacking=of.lacking is not None,
        inside=_inside(of, whole, error, rng),
    )
    return frame, numbers


def _inside(
    of: Predicted, whole: FloatArray, error: float, rng: np.random.Generator
) -> float | None:
    """Return the share of the measured points within the band of new measurements."""
    if of.value is None or of.sd is None:
        return None
    low, _, high = band(whole + of.sd * rng.standard_normal(whole.shape))
    return float(np.mean((low - error <= of.value) & (of.value <= high + error)))
