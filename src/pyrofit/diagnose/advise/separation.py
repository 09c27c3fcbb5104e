"""The next experiment: which measurement would separate models that the data cannot tell apart.

D is the difference of the predictions of two fitted models. J_i are the derivatives of the
predictions with respect to the parameters. Both are whitened with the noise of the new record. C_i
is the covariance of the parameters after the calibration. The separation in standard deviations,

    sqrt(D^T (I + J_1 C_1 J_1^T + J_2 C_2 J_2^T)^-1 D),

leaves out differences that a model could make up for within the uncertainty of its parameters (as
Buzzi-Ferraris and Forzatti 1984, Chem. Eng. Sci. 39, 81).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from pyrofit.diagnose.advise.candidate_experiments import ideas
from pyrofit.diagnose.advise.new_record import (
    kind_of_record,
    noise_of_record,
    requests_of,
    simulated_test,
)
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.estimate.derivatives import derivatives
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.posterior import curvature
from pyrofit.experiments.base import Idea
from pyrofit.numerics import linear
from pyrofit.parallel import parallel_map
from pyrofit.results.diagnosis_schema import OfExperiment
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.run import LANES

SETS = 2 * (LANES - 1)
"""Sets beside the leading one that run at once: a record may have 20,000 points."""


@dataclass(frozen=True, eq=False)
class _Forecast:
    """Curve of each signal at a model's fit, and its spread by the parameters' uncertainty.

    ``spread`` has shape (points, parameters), spread @ spread.T is the curve's covariance.
    """

    curve: dict[str, FloatArray]
    spread: dict[str, FloatArray]


def next_experiments(trials: Sequence[FittedModel], processes: int = 1) -> list[OfExperiment]:
    """Return new measurements, that which separates fitted models best first.

    Parameters
    ----------
    trials
        Models fitted to the same channels; fewer than two leave nothing to separate.
    processes
        Processes that share the simulations.
    """
    if len(trials) < 2:
        return []
    model = trials[0].model
    tried = list(ideas(model.likelihood.problem, model.base.likelihood.problem))
    designs = parallel_map(lambda k: _designs(trials, tried[k]), len(tried), processes)
    found = [design for of_idea in designs for design in of_idea]
    return sorted(found, key=lambda d: (d.separation_sd, sum(d.pairs.values())), reverse=True)


def _designs(trials: Sequence[FittedModel], idea: Idea) -> list[OfExperiment]:
    """Return an idea with each choice of its signals; none where a simulation does not finish."""
    kinds = {s: kind_of_record(trials[0].model.base, s) for s in idea.most_quantities}
    requests = requests_of(trials, idea, kinds)
    forecasts = [_forecast(trial, idea, requests) for trial in trials]
    known = [forecast for forecast in forecasts if forecast is not None]
    if len(known) < len(trials):
        return []
    noise = {s: noise_of_record(kinds[s], r.time_s, known[0].curve[s]) for s, r in requests.items()}
    names = [_name(trial) for trial in trials]
    found = []
    for design, words, signals in idea.choices:
        of = {signal: noise[signal] for signal in signals}
        each = {
            f"{names[i]} | {names[j]}": _separation(known[i], known[j], of)
            for i, j in combinations(range(len(known)), 2)
        }
        least = min(each.values())
        row = OfExperiment(design=design, words=words, separation_sd=least, pairs=each)
        found.append(row)
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
    seen = linear.product(A.T, D)
    left = linear.solve(np.eye(seen.size) + linear.gram(A), seen)
    rest = linear.dot(D, D) - linear.dot(seen, left)
    return math.sqrt(max(rest, 0.0))


def _forecast(trial: FittedModel, idea: Idea, requests: Mapping[str, Request]) -> _Forecast | None:
    """Return the predictions of a model; None where a run does not finish."""
    x = trial.fit.x
    (curves,) = simulated_test(trial, idea, x[None], requests)
    if not curves.status.finished:
        return None

    here = _stacked(curves, requests)

    def stacked(X: FloatArray) -> list[FloatArray | None]:
        found: list[FloatArray | None] = [here]
        for i in range(1, len(X), SETS):
            led = simulated_test(trial, idea, np.vstack([X[:1], X[i : i + SETS]]), requests)[1:]
            found += [_stacked(run, requests) if run.status.finished else None for run in led]
        return found

    slopes, found = derivatives(stacked, x, here)
    if not np.all(found):
        return None
    bend = curvature(trial.fit.jacobian)
    # C = bend^-1 = R R^T with R = L^-T of Cholesky's bend = L L^T.
    R = linear.inverse_root(bend).T
    ends = np.cumsum([request.time_s.size for request in requests.values()])
    return _Forecast(
        curve={signal: curves.signals[signal] for signal in requests},
        spread=dict(zip(requests, np.split(linear.product(slopes, R), ends[:-1]), strict=True)),
    )


def _stacked(curves: Curves, requests: Mapping[str, Request]) -> FloatArray:
    return np.concatenate([curves.signals[signal] for signal in requests])
