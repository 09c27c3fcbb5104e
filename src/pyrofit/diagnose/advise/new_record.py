"""The record of a test that was not made: its times, its noise, its simulation."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Base
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.noise import NoiseModel
from pyrofit.experiments import kind_of
from pyrofit.experiments.base import Idea
from pyrofit.model.signal import TIMING_S
from pyrofit.quantities import known_quantities
from pyrofit.solver.arrays import FloatArray, Values
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.outputs import MASS


@dataclass(frozen=True, eq=False)
class RecordKind:
    """Noise of a signal in this study, the spacing of its points and its clock's error [s]."""

    sd: float
    correlation: Correlation
    spacing_s: float
    timing_s: float


def simulated_test(
    trial: FittedModel, idea: Idea, X: FloatArray, requests: Mapping[str, Request]
) -> list[Curves]:
    """Simulate the new test with a model's own description of the one it is like.

    The first of the sets, X of shape (sets, parameters), leads the others.
    """
    likelihood = trial.model.likelihood
    problem = likelihood.problem
    columns = dict(zip(problem.names, likelihood.values(X).T, strict=True))
    values: Values = {**problem.fixed, **columns}
    experiment = idea.change(problem.runs[idea.like].experiment)
    simulate, accuracy = kind_of(experiment).simulate, problem.accuracy
    return simulate([experiment], problem.material, values, [requests], accuracy, len(X), True)[0]


def requests_of(
    trials: Sequence[FittedModel], idea: Idea, kinds: Mapping[str, RecordKind]
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
    fewest = trials[0].settings.design_fewest_times
    widths = {
        run.experiment.quantity(name).name: signal.average_s
        for name, signal in run.experiment.signals.items()
    }
    return {
        name: Request(
            _times(kind.spacing_s, end, fewest),
            widths.get(name, 0.0),
            output=known_quantities()[name].curve,
        )
        for name, kind in kinds.items()
    }


def _times(spacing: float, end: float, fewest: int) -> FloatArray:
    """Return times of a record, ``fewest`` at least."""
    spacing = min(spacing, end / fewest)
    return np.arange(spacing, end, spacing)


def _burnt_out(trial: FittedModel, idea: Idea) -> float:
    """Return the time at which a test may end [s]."""
    longest, spacing = trial.settings.design_longest_s, trial.settings.design_spacing_s
    time = np.arange(0.0, longest + spacing, spacing)
    (curves,) = simulated_test(trial, idea, trial.fit.x[None], {MASS: Request(time)})
    if not curves.status.finished:
        return longest
    lost = curves.signals[MASS][0] - curves.signals[MASS]
    if lost[-1] <= 0.0:
        return longest
    end = float(time[np.searchsorted(lost, trial.settings.design_burnt_out * lost[-1])])
    return min(1.1 * end, longest)


def kind_of_record(base: Base, quantity: str) -> RecordKind:
    """Return the noise of a quantity's channel that is neither the quietest nor the noisiest."""
    terms, runs = base.likelihood.problem.cost.terms, base.likelihood.problem.runs
    found = [
        RecordKind(
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
        return RecordKind(sd, Correlation(), base.settings.design_spacing_s, TIMING_S)
    return sorted(found, key=lambda kind: kind.sd)[len(found) // 2]


def noise_of_record(kind: RecordKind, time: FloatArray, curve: FloatArray) -> NoiseModel:
    """Return the noise of a new record, with the clock's error where the curve is steep."""
    steep = kind.timing_s * np.gradient(curve, time)
    return NoiseModel(np.hypot(kind.sd, steep), kind.correlation)
