"""What a claim must pass besides its gain: limits, agreement of experiments, prediction.

A prediction is scored by the logarithm of its density (Gneiting and Raftery 2007,
doi 10.1198/016214506000001437), parameters uncertain as the calibration leaves them:

    log p(y_out | y_cal) = log p(y_out, y_cal) - log p(y_cal),
    log p(y) = -(min chi2 + log det(J^T J + Pi))/2 + constant   (Laplace),

Pi the inverse variance of a value anywhere within its limits. So a model that predicts badly, but
leaves room for that, loses less than one that is sure of itself.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2 as chi_squared

from pyrofit.diagnose.base.adequacy import lack_of_fit
from pyrofit.diagnose.base.descent import Fit, descend
from pyrofit.diagnose.base.fit import refitted, with_noise_about
from pyrofit.diagnose.base.fitted import FittedModel, at_limit, up_to_date
from pyrofit.diagnose.base.model import Model, model_of
from pyrofit.diagnose.base.projection import project, projector
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.estimate.posterior import curvature
from pyrofit.experiments import kind_of
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray

HELD_OUT = "held out"


@dataclass(frozen=True)
class Trust:
    """What speaks for or against an effect besides the calibration."""

    limit: str
    """The effect's strength if it rests at a limit, or empty."""
    disagree: float
    """Probability that equal strengths look as different between experiments."""
    gains: dict[str, float]
    """Gain of the log score, by experiments left out or held out."""
    explains: bool
    """Whether the model fits what is held out as well, once that is fitted, too."""

    @property
    def informative(self) -> bool:
        """Whether some prediction distinguishes the models."""
        return any(abs(gain) >= SETTINGS.informative_gain for gain in self.gains.values())

    @property
    def predicts(self) -> bool:
        """Whether predictions improve on the whole, and none gets clearly worse."""
        total = sum(self.gains.values())
        return (
            total >= SETTINGS.informative_gain
            and min(self.gains.values(), default=0.0) > -SETTINGS.informative_gain
        )

    @property
    def confirmed(self) -> bool:
        """Whether predictions improve and what is held out, if anything, gains enough by itself."""
        return (
            self.predicts
            and self.gains.get(HELD_OUT, SETTINGS.informative_gain) >= SETTINGS.informative_gain
        )


@dataclass(frozen=True, eq=False)
class Predictions:
    """Log scores by experiment left out, or held out, and the fit to all signals."""

    scores: dict[str, float]
    whole: FittedModel


def disagreement(trial: FittedModel, effect: str) -> float:
    """Return the probability that a strength common to all experiments looks as different.

    Score test: the columns of d w/d strength, one experiment each, against what the fit leaves.
    """
    model, fit = trial.model, trial.fit
    column = fit.jacobian[: model.points, model.position(effect)]
    owners = [model.base.channels[i][0] for i in model.channels]
    parts = np.split(column, np.cumsum(model.likelihood.points)[:-1])
    moved = [o for o in dict.fromkeys(owners) if _size(parts, owners, o) > 1e-9]
    if len(moved) < 2:
        return 1.0
    d = np.zeros((fit.residuals.size, len(moved) - 1))
    for k, experiment in enumerate(moved[1:]):
        own = [p if o == experiment else 0.0 * p for p, o in zip(parts, owners, strict=True)]
        d[: model.points, k] = np.concatenate(own)
    d = project(projector(fit), d)
    found = np.linalg.lstsq(d, fit.residuals, rcond=1e-8)[0]
    return float(chi_squared.sf(float(fit.residuals @ d @ found), len(moved) - 1))


def _size(parts: Sequence[FloatArray], owners: Sequence[str], experiment: str) -> float:
    return max(
        float(np.abs(p).max()) for p, o in zip(parts, owners, strict=True) if o == experiment
    )


def forecast(part: Fit, whole: Fit) -> float:
    """Return the log score of what a fit to the whole has more than a fit to a part."""
    misfit = whole.chi2 - part.chi2
    return -0.5 * (misfit + _log_det(whole) - _log_det(part))


def _log_det(fit: Fit) -> float:
    return float(np.linalg.slogdet(curvature(fit.jacobian))[1])


def slabs(trial: FittedModel) -> list[str]:
    """Return the calibrated experiments that show the slab: without any of them others remain."""
    base = trial.model.base
    found = [base.channels[i] for i in trial.model.channels]
    runs = base.likelihood.problem.runs
    names = dict.fromkeys(n for n, _ in found if kind_of(runs[n].experiment).stage == "imp")
    return list(names) if len(names) > 1 else []


def predictions(trials: Sequence[FittedModel], processes: int = 1) -> list[Predictions]:
    """Return what models predict: experiments from the others, and what is held out."""
    tasks = [(k, HELD_OUT) for k, trial in enumerate(trials) if trial.model.base.held_out]
    tasks += [(k, name) for k, trial in enumerate(trials) for name in slabs(trial)]
    fits = parallel_map(
        lambda i: _refit(trials[tasks[i][0]], tasks[i][1]).fit, len(tasks), processes
    )
    found = [Predictions({}, trial) for trial in trials]
    for (k, name), fit in zip(tasks, fits, strict=True):
        part, whole = (trials[k].fit, fit) if name == HELD_OUT else (fit, trials[k].fit)
        found[k].scores[name] = forecast(part, whole)
        if name == HELD_OUT:
            found[k] = replace(found[k], whole=FittedModel(_model_for(trials[k], HELD_OUT), fit))
    return found


def _model_for(trial: FittedModel, prediction: str) -> Model:
    """Return the model against all channels, or without those of an experiment."""
    base, used = trial.model.base, trial.model.channels
    rest = tuple(i for i in used if base.channels[i][0] != prediction)
    channels = (*used, *base.held_out) if prediction == HELD_OUT else rest
    return model_of(base, trial.model.effects, channels)


def _refit(trial: FittedModel, prediction: str) -> FittedModel:
    model = _model_for(trial, prediction)
    return up_to_date(FittedModel(model, descend(model, trial.fit.x)))


def explains(found: Predictions, rng: np.random.Generator) -> bool:
    """Tell whether a model fits what is held out as well, once that is fitted, too.

    ``rng`` draws the noise that it is compared with. The scores are compared under one noise; this
    is judged under the one that the fit leaves.
    """
    held_out = found.whole.model.base.held_out
    if not held_out:
        return True
    whole = refitted(found.whole, with_noise_about(found.whole, held_out))
    return lack_of_fit(whole.model, whole.fit, [], rng).adequate


def trust(
    trial: FittedModel, effect: str, own: Predictions, without: Predictions, explained: bool
) -> Trust:
    """Return what speaks for or against an effect of a model.

    Parameters
    ----------
    own, without
        What the model predicts, and what it predicts without the effect.
    explained
        Whether it fits what is held out, too.
    """
    gains = {name: own.scores[name] - before for name, before in without.scores.items()}
    return Trust(at_limit(trial, effect), disagreement(trial, effect), gains, explained)
