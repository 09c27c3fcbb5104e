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

from pyrofit.diagnose.descent import Fit, descend
from pyrofit.diagnose.locate import alarm
from pyrofit.diagnose.model import Model, curvature, model_of, strength_of
from pyrofit.diagnose.refit import Trial, up_to_date
from pyrofit.diagnose.screen import project, projector
from pyrofit.diagnose.setup import refitted, with_noise_about
from pyrofit.experiments import kind_of
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray

HELD_OUT = "held out"
AT_LIMIT = 0.005
"""A parameter within this fraction of the limits' distance from a limit rests there."""
AGREE = 1e-3
"""Probability below which strengths that differ from one experiment to another are no chance."""
INFORMATIVE = 2.0
"""Difference of log scores that counts: odds of 7 to 1."""


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
        return any(abs(gain) >= INFORMATIVE for gain in self.gains.values())

    @property
    def predicts(self) -> bool:
        """Whether predictions improve on the whole, and none gets clearly worse."""
        total = sum(self.gains.values())
        return total >= INFORMATIVE and min(self.gains.values(), default=0.0) > -INFORMATIVE

    @property
    def confirmed(self) -> bool:
        """Whether predictions improve and what is held out, if anything, gains enough by itself."""
        return self.predicts and self.gains.get(HELD_OUT, INFORMATIVE) >= INFORMATIVE


@dataclass(frozen=True, eq=False)
class Predictions:
    """Log scores by experiment left out, or held out, and the fit to all signals."""

    scores: dict[str, float]
    whole: Trial


def at_limit(trial: Trial, effect: str) -> str:
    """Return the name of an effect's strength if it rests at a limit, else nothing.

    Nothing left of what is usually there is no limit but a state, as an insulated back is. A form
    may be as extreme as its limits allow: a step that is sharper than the data can show.
    """
    x = trial.fit.x[trial.model.position(effect)]
    _, quantity = strength_of(effect)
    lowest = -1.0 if quantity.lower == 0.0 < quantity.value else AT_LIMIT
    name = trial.model.names[trial.model.position(effect)]
    return "" if lowest < x < 1.0 - AT_LIMIT else name


def disagreement(trial: Trial, effect: str) -> float:
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


def slabs(trial: Trial) -> list[str]:
    """Return the calibrated experiments that show the slab: without any of them others remain."""
    base = trial.model.base
    found = [base.channels[i] for i in trial.model.channels]
    runs = base.likelihood.problem.runs
    names = dict.fromkeys(n for n, _ in found if kind_of(runs[n].experiment).stage == "imp")
    return list(names) if len(names) > 1 else []


def predictions(trials: Sequence[Trial], processes: int = 1) -> list[Predictions]:
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
            found[k] = replace(found[k], whole=Trial(_model_for(trials[k], HELD_OUT), fit))
    return found


def _model_for(trial: Trial, prediction: str) -> Model:
    """Return the model against all channels, or without those of an experiment."""
    base, used = trial.model.base, trial.model.channels
    rest = tuple(i for i in used if base.channels[i][0] != prediction)
    channels = (*used, *base.held_out) if prediction == HELD_OUT else rest
    return model_of(base, trial.model.effects, channels)


def _refit(trial: Trial, prediction: str) -> Trial:
    model = _model_for(trial, prediction)
    return up_to_date(Trial(model, descend(model, trial.fit.x)))


def explains(found: Predictions, rng: np.random.Generator) -> bool:
    """Tell whether a model fits what is held out as well, once that is fitted, too.

    ``rng`` draws the noise that it is compared with. The scores are compared under one noise; this
    is judged under the one that the fit leaves.
    """
    held_out = found.whole.model.base.held_out
    if not held_out:
        return True
    whole = refitted(found.whole, with_noise_about(found.whole, held_out))
    return alarm(whole.model, whole.fit, [], rng).adequate


def trust(
    trial: Trial, effect: str, own: Predictions, without: Predictions, explained: bool
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
