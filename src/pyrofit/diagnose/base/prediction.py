"""Predictions by fitted models, of experiments left out of the fit, or held out of the study.

A prediction is scored by the logarithm of its density (Gneiting and Raftery 2007,
doi 10.1198/016214506000001437), parameters uncertain as the calibration leaves them:

    log p(y_out | y_cal) = log p(y_out, y_cal) - log p(y_cal),
    log p(y) = -(min chi2 + log det(J^T J + Pi))/2 + constant   (Laplace),

Pi the inverse variance of a value anywhere within its limits. A model that predicts badly but has
wide intervals loses less than one with narrow intervals.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from pyrofit.diagnose.base.descent import Fit, descend_chi_square
from pyrofit.diagnose.base.fitted import FittedModel, up_to_date
from pyrofit.diagnose.base.model import Base, Model, model_of
from pyrofit.estimate.posterior import curvature
from pyrofit.experiments import kind_of
from pyrofit.numerics import linear
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray

HELD_OUT = "held out"
Made = dict[tuple[Fit, str], Fit]
"""Fits made for predictions, by the fit that they start from and the name of the prediction."""


@dataclass(frozen=True, eq=False)
class Predictions:
    """Log scores by experiment left out, or held out, and the fit to all signals."""

    scores: dict[str, float]
    residuals: dict[str, list[FloatArray]]
    """Whitened residuals of the predicted signals, if they are fitted too, by prediction."""
    whole: FittedModel
    parts: dict[str, FittedModel] = field(default_factory=dict)
    """The fits that predict, by prediction."""
    channels: dict[str, tuple[int, ...]] = field(default_factory=dict)
    """The predicted channels, by prediction."""

    @property
    def total(self) -> float:
        """Sum of the log scores."""
        return sum(self.scores.values())


def score_forecast(part: Fit, whole: Fit) -> float:
    """Return the log score of the signals that are fitted in the whole, but not in a part."""
    misfit = whole.chi2 - part.chi2
    return -0.5 * (misfit + _log_det(whole) - _log_det(part))


def _log_det(fit: Fit) -> float:
    return linear.log_det(curvature(fit.jacobian))


def slab_experiments(trial: FittedModel) -> list[str]:
    """Return the calibrated experiments that show the slab: without any of them others remain."""
    base = trial.model.base
    found = [base.channels[i] for i in trial.model.channels]
    runs = base.likelihood.problem.runs
    names = dict.fromkeys(n for n, _ in found if kind_of(runs[n].experiment).stage == "imp")
    return list(names) if len(names) > 1 else []


def model_predictions(
    trials: Sequence[FittedModel],
    processes: int = 1,
    held_out: bool = True,
    whole: bool = True,
    made: Made | None = None,
) -> list[Predictions]:
    """Return the predictions of models: experiments from the others, and held-out signals.

    With ``held_out`` false, only calibrated experiments are left out, one by one. With ``whole``
    false, no model is fitted to all held-out tests at once, unless a score needs it. Fits that are
    ``made`` already are not made again; new ones are added to them.
    """
    made = {} if made is None else made
    tasks = [(k, name) for k, trial in enumerate(trials) for name in _tasks(trial, held_out, whole)]
    tasks.sort(key=lambda task: not task[1].startswith(HELD_OUT))  # the longest ones first
    wanted = {(trials[k].fit, name): trials[k] for k, name in tasks}
    new = [key for key in wanted if key not in made]
    fits = parallel_map(lambda i: _refit(wanted[new[i]], new[i][1]).fit, len(new), processes)
    made.update(zip(new, fits, strict=True))
    found = [Predictions({}, {}, trial) for trial in trials]
    for k, name in tasks:
        fit = made[trials[k].fit, name]
        part, joint = trials[k], FittedModel(_model_for(trials[k], name), fit)
        if name == HELD_OUT:
            found[k] = replace(found[k], whole=joint)
        if not name.startswith(HELD_OUT):
            part, joint = joint, part
        if name != HELD_OUT or not _several(trials[k]):
            found[k].scores[name] = score_forecast(part.fit, joint.fit)
            found[k].residuals[name] = _added(part, joint)
            found[k].parts[name] = part
            used = part.model.channels
            found[k].channels[name] = tuple(i for i in joint.model.channels if i not in used)
    return found


def _added(part: FittedModel, joint: FittedModel) -> list[FloatArray]:
    """Return the residuals of the signals that only the joint fit has."""
    channels = zip(joint.model.channels, joint.model.by_channel(joint.fit.residuals), strict=True)
    return [w for channel, w in channels if channel not in part.model.channels]


def _tasks(trial: FittedModel, held_out: bool, whole: bool) -> list[str]:
    """Return the predictions of a model: all held out, each of several places, each left out."""
    several = _several(trial)
    at_once = [HELD_OUT] if trial.model.base.held_out and (whole or not several) else []
    return [*(at_once + several if held_out else []), *slab_experiments(trial)]


def _several(trial: FittedModel) -> list[str]:
    """Return the names of the predictions of held-out signals, if there are several.

    Tests of one laboratory are one prediction: an error of its apparatus shows in all of them.
    """
    base = trial.model.base
    places = dict.fromkeys(_place(base, i) for i in base.held_out)
    return [f"{HELD_OUT}: {place}" for place in places] if len(places) > 1 else []


def prediction_of(trial: FittedModel, channel: int) -> str:
    """Return the name of the prediction that a held-out channel belongs to."""
    place = f"{HELD_OUT}: {_place(trial.model.base, channel)}"
    return place if _several(trial) else HELD_OUT


def _place(base: Base, channel: int) -> str:
    """Return the laboratory of a channel, else the name of its test."""
    name, _ = base.channels[channel]
    experiment = base.likelihood.problem.runs[name].experiment
    return experiment.laboratory or (experiment.repeat.test if experiment.repeat else name)


def _model_for(trial: FittedModel, prediction: str) -> Model:
    """Return the model against all channels, with one held-out place, or without one test."""
    base, used = trial.model.base, trial.model.channels
    _, out, place = prediction.partition(f"{HELD_OUT}: ")
    if prediction == HELD_OUT:
        channels = (*used, *base.held_out)
    elif out:
        channels = (*used, *(i for i in base.held_out if _place(base, i) == place))
    else:
        channels = tuple(i for i in used if base.channels[i][0] != prediction)
    return model_of(base, trial.model.effects, channels)


def _refit(trial: FittedModel, prediction: str) -> FittedModel:
    model = _model_for(trial, prediction)
    begin = _derivatives(trial, model) if trial.fit.fresh else None
    return up_to_date(FittedModel(model, descend_chi_square(model, trial.fit.x, begin)))


def _derivatives(trial: FittedModel, model: Model) -> FloatArray:
    """Return the derivatives of the same effects against other channels, where a fit stands.

    Those of the channels that the fit has are at hand.
    """
    x, known = trial.fit.x, trial.fit.jacobian[trial.model.points :]
    rows = dict(zip(trial.model.channels, trial.model.by_channel(trial.fit.jacobian), strict=True))
    added = [i for i in model.channels if i not in rows]
    if added:
        new = model_of(trial.model.base, trial.model.effects, added)
        slopes = new.jacobian(x, new.residuals(x))
        rows |= dict(zip(added, new.by_channel(slopes), strict=True))
    return np.vstack([*(rows[i] for i in model.channels), known])
