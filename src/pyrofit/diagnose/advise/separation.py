"""The next experiment: which measurement would separate models that the data cannot tell apart.

D is the difference of the predictions of two fitted models, whitened with the noise of the new
record, J_i are the predictions' derivatives with respect to the parameters, whitened too, and C_i
the parameters' covariance after the calibration. The separation in standard deviations,

    sqrt(D^T (I + J_1 C_1 J_1^T + J_2 C_2 J_2^T)^-1 D),

leaves out what a model could make up within what the calibration leaves it (as Buzzi-Ferraris and
Forzatti 1984, Chem. Eng. Sci. 39, 81).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from pyrofit.diagnose.advise.candidate_experiments import ideas
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Base
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.derivatives import derivatives
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.posterior import curvature
from pyrofit.experiments import kind_of
from pyrofit.experiments.base import Idea
from pyrofit.model.signal import TIMING_S
from pyrofit.quantities import known_quantities
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.outputs import MASS


@dataclass(frozen=True)
class Design:
    """A measurement that was not made.

    Parameters
    ----------
    design
        Short name.
    words
        What it is.
    separation_sd
        By how many standard deviations it separates those two models that it separates least.
    pairs
        The same of each two models.
    """

    design: str
    words: str
    separation_sd: float
    pairs: dict[str, float]


@dataclass(frozen=True, eq=False)
class _Kind:
    """Noise of a signal in this study, the spacing of its points and its clock's error [s]."""

    sd: float
    correlation: Correlation
    spacing_s: float
    timing_s: float


@dataclass(frozen=True, eq=False)
class _Forecast:
    """Curve of each signal at a model's fit, and what the parameters' uncertainty makes of it.

    ``spread`` has shape (points, parameters), spread @ spread.T is the curve's covariance.
    """

    curve: dict[str, FloatArray]
    spread: dict[str, FloatArray]


def next_experiments(trials: Sequence[FittedModel]) -> list[Design]:
    """Return new measurements, that which separates fitted models best first.

    Parameters
    ----------
    trials
        Models fitted to the same channels; fewer than two leave nothing to separate.
    """
    if len(trials) < 2:
        return []
    found: list[Design] = []
    model = trials[0].model
    for idea in ideas(model.likelihood.problem, model.base.likelihood.problem):
        found += _designs(trials, idea)
    return sorted(found, key=lambda d: (d.separation_sd, sum(d.pairs.values())), reverse=True)


def _designs(trials: Sequence[FittedModel], idea: Idea) -> list[Design]:
    """Return an idea with each choice of its signals; none where a simulation does not finish."""
    kinds = {s: _kind(trials[0].model.base, s) for s in idea.most_quantities}
    requests = _requests(trials, idea, kinds)
    forecasts = [_forecast(trial, idea, requests) for trial in trials]
    known = [forecast for forecast in forecasts if forecast is not None]
    if len(known) < len(trials):
        return []
    noise = {s: _noise(kinds[s], r.time_s, known[0].curve[s]) for s, r in requests.items()}
    names = [_name(trial) for trial in trials]
    found = []
    for design, words, signals in idea.choices:
        of = {signal: noise[signal] for signal in signals}
        each = {
            f"{names[i]} | {names[j]}": _separation(known[i], known[j], of)
            for i, j in combinations(range(len(known)), 2)
        }
        found.append(Design(design, words, min(each.values()), each))
    return found


def _name(trial: FittedModel) -> str:
    """Name a model by its effects, with the form parameters that are fitted."""
    free = [[name, *parameters[1:]] for name, parameters in trial.model.effects.items()]
    return " + ".join(" ".join(words) for words in free) or "base"


def _separation(one: _Forecast, other: _Forecast, noise: Mapping[str, NoiseModel]) -> float:
    """Return the separation in standard deviations, by Woodbury's identity.

    D^T (I + A A^T)^-1 D = |D|^2 - D^T A (I + A^T A)^-1 A^T D, A = (A_1, A_2).
    """

    def stacked(parts: dict[str, FloatArray], others: dict[str, FloatArray]) -> list[FloatArray]:
        return [np.concatenate([n.whiten(p[s]) for s, n in noise.items()]) for p in (parts, others)]

    y, z = stacked(one.curve, other.curve)
    D, A = y - z, np.column_stack(stacked(one.spread, other.spread))
    seen = A.T @ D
    rest = float(D @ D - seen @ np.linalg.solve(np.eye(seen.size) + A.T @ A, seen))
    return math.sqrt(max(rest, 0.0))


def _forecast(trial: FittedModel, idea: Idea, requests: Mapping[str, Request]) -> _Forecast | None:
    """Return what a model predicts; None where it does not finish."""
    x = trial.fit.x
    curves = _run(trial, idea, x, requests)
    if not curves.status.finished:
        return None

    def stacked(X: FloatArray) -> list[FloatArray | None]:
        runs = [_run(trial, idea, there, requests) for there in X]
        return [_stacked(run, requests) if run.status.finished else None for run in runs]

    here = _stacked(curves, requests)
    slopes, found = derivatives(stacked, x, here, 1, step=SETTINGS.difference_step)
    if not np.all(found):
        return None
    bend = curvature(trial.fit.jacobian)
    # C = bend^-1 = R R^T with R = L^-T of Cholesky's bend = L L^T.
    R = np.linalg.inv(np.linalg.cholesky(bend)).T
    ends = np.cumsum([request.time_s.size for request in requests.values()])
    return _Forecast(
        curve={signal: curves.signals[signal] for signal in requests},
        spread=dict(zip(requests, np.split(slopes @ R, ends[:-1]), strict=True)),
    )


def _stacked(curves: Curves, requests: Mapping[str, Request]) -> FloatArray:
    return np.concatenate([curves.signals[signal] for signal in requests])


def _run(trial: FittedModel, idea: Idea, x: FloatArray, requests: Mapping[str, Request]) -> Curves:
    """Simulate the new test with a model's own description of the one it is like."""
    likelihood = trial.model.likelihood
    problem = likelihood.problem
    values = problem.values(likelihood.values(x))
    experiment = idea.change(problem.runs[idea.like].experiment)
    simulate = kind_of(experiment).simulate
    return simulate([experiment], problem.material, values, [requests], problem.accuracy)[0][0]


def _requests(
    trials: Sequence[FittedModel], idea: Idea, kinds: Mapping[str, _Kind]
) -> dict[str, Request]:
    """Return times until all models have burnt out; of a TGA, the measured range of temperature."""
    run = trials[0].model.likelihood.problem.runs[idea.like]
    request = next(iter(run.requests.values()))
    if request.temperature_K is not None:
        T = np.linspace(request.temperature_K[0], request.temperature_K[-1], request.time_s.size)
        rate = idea.change(run.experiment).heating_rate_K_min / 60.0
        heated = Request((T - T[0]) / rate, temperature_K=T)
        return {name: replace(heated, output=known_quantities()[name].curve) for name in kinds}
    end = max(_burnt_out(trial, idea) for trial in trials)
    widths = {
        run.experiment.quantity(name).name: signal.average_s
        for name, signal in run.experiment.signals.items()
    }
    return {
        name: Request(
            _times(kind.spacing_s, end),
            widths.get(name, 0.0),
            output=known_quantities()[name].curve,
        )
        for name, kind in kinds.items()
    }


def _times(spacing: float, end: float) -> FloatArray:
    """Return times of a record, twenty at least."""
    spacing = min(spacing, end / SETTINGS.design_fewest_times)
    return np.arange(spacing, end, spacing)


def _burnt_out(trial: FittedModel, idea: Idea) -> float:
    """Return the time at which a test may end [s]."""
    time = np.arange(
        0.0, SETTINGS.design_longest_s + SETTINGS.design_spacing_s, SETTINGS.design_spacing_s
    )
    curves = _run(trial, idea, trial.fit.x, {MASS: Request(time)})
    if not curves.status.finished:
        return SETTINGS.design_longest_s
    lost = curves.signals[MASS][0] - curves.signals[MASS]
    if lost[-1] <= 0.0:
        return SETTINGS.design_longest_s
    end = float(time[np.searchsorted(lost, SETTINGS.design_burnt_out * lost[-1])])
    return min(1.1 * end, SETTINGS.design_longest_s)


def _kind(base: Base, quantity: str) -> _Kind:
    """Return the noise of a quantity's channel that is neither the quietest nor the noisiest."""
    terms, runs = base.likelihood.problem.cost.terms, base.likelihood.problem.runs
    found = [
        _Kind(
            float(np.median(noise.sd)),
            noise.correlation,
            float(np.median(np.diff(term.target.time_s))),
            runs[experiment].experiment.signals[name].timing_s,
        )
        for (experiment, name), noise, (_, term) in zip(
            base.channels, base.likelihood.noise, terms, strict=True
        )
        if runs[experiment].experiment.quantity(name).name == quantity
    ]
    if not found:
        # ASSUME: the noise of a quantity that the study does not measure is white.
        sd = known_quantities()[quantity].usual_sd
        return _Kind(sd, Correlation(), SETTINGS.design_spacing_s, TIMING_S)
    return sorted(found, key=lambda kind: kind.sd)[len(found) // 2]


def _noise(kind: _Kind, time: FloatArray, curve: FloatArray) -> NoiseModel:
    """Return the noise of a new record, with the clock's error where the curve is steep."""
    steep = kind.timing_s * np.gradient(curve, time)
    return NoiseModel(np.hypot(kind.sd, steep), kind.correlation)
