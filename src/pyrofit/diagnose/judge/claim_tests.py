"""Tests of a claim besides its gain: limits, agreement of experiments, prediction.

A model that still misfits makes every test statistic too large. Its dispersion, chi-square per
degree of freedom, then divides the statistics and the gains of the log scores.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2 as chi_squared

from pyrofit.diagnose.base.adequacy import lack_of_fit
from pyrofit.diagnose.base.fit import refitted, with_noise_about
from pyrofit.diagnose.base.fitted import FittedModel, at_limit
from pyrofit.diagnose.base.prediction import HELD_OUT, Predictions
from pyrofit.diagnose.base.projection import project, projector
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True)
class Trust:
    """Evidence for or against an effect besides the calibration."""

    limit: str
    """The effect's strength if it rests at a limit, or empty."""
    disagree: float
    """Probability that equal strengths look as different between experiments."""
    gains: dict[str, float]
    """Gain of the log score, by experiments left out or held out."""
    explains: bool | None
    """Whether the model fits the held-out signals as well, if they are fitted, too. None if not
    tested, because it leaves more than noise of the calibrated signals."""

    @property
    def informative(self) -> bool:
        """Whether some prediction distinguishes the models."""
        return any(abs(gain) >= SETTINGS.informative_gain for gain in self.gains.values())

    @property
    def predicts(self) -> bool:
        """Whether predictions improve on the whole, and none gets clearly worse.

        One held-out experiment alone does not decide against several others: its apparatus may be
        the reason.
        """
        if self.outvoted:
            return True
        return not self.worse and sum(self.gains.values()) >= SETTINGS.informative_gain

    @property
    def worse(self) -> list[str]:
        """Predictions that get clearly worse."""
        return [n for n, gain in self.gains.items() if gain <= -SETTINGS.informative_gain]

    @property
    def outvoted(self) -> bool:
        """Whether one held-out experiment alone gets worse, and several predictions improve."""
        better = [n for n, gain in self.gains.items() if gain >= SETTINGS.informative_gain]
        return len(self.worse) == 1 and self.worse[0] in self.held_out and len(better) > 1

    @property
    def confirmed(self) -> bool:
        """Whether predictions improve and held-out signals, if any, gain enough by themselves."""
        held_out = self.held_out
        return self.predicts and (
            not held_out or sum(held_out.values()) >= SETTINGS.informative_gain
        )

    @property
    def held_out(self) -> dict[str, float]:
        """Gains of the log score of held-out signals."""
        return {n: gain for n, gain in self.gains.items() if n.startswith(HELD_OUT)}


def disagreement(trial: FittedModel, effect: str, dispersion: float = 1.0) -> float:
    """Return the probability that a strength common to all experiments looks as different.

    Score test: the columns of d w/d strength, one experiment each, against the fit's residuals.
    The statistic is divided by ``dispersion``.
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
    return float(chi_squared.sf(float(fit.residuals @ d @ found) / dispersion, len(moved) - 1))


def _size(parts: Sequence[FloatArray], owners: Sequence[str], experiment: str) -> float:
    return max(
        float(np.abs(p).max()) for p, o in zip(parts, owners, strict=True) if o == experiment
    )


def explains(found: Predictions, rng: np.random.Generator) -> bool:
    """Tell whether a model fits held-out signals as well, if they are fitted, too.

    ``rng`` draws the noise that the residuals are compared with. The scores are compared under one
    noise; this is judged under the noise estimated about the fit.
    """
    held_out = found.whole.model.base.held_out
    if not held_out:
        return True
    whole = refitted(found.whole, with_noise_about(found.whole, held_out))
    return lack_of_fit(whole.model, whole.fit, [], rng).adequate


def trust(
    trial: FittedModel,
    effect: str,
    own: Predictions,
    without: Predictions,
    explained: bool | None,
    dispersion: float = 1.0,
) -> Trust:
    """Return the evidence for or against an effect of a model.

    Parameters
    ----------
    own, without
        Predictions of the model with and without the effect.
    explained
        Whether it fits held-out signals, too.
    dispersion
        Chi-square per degree of freedom that divides test statistics and gains.
    """
    gains = {
        name: (own.scores[name] - before) / dispersion for name, before in without.scores.items()
    }
    disagree = disagreement(trial, effect, dispersion)
    return Trust(at_limit(trial, effect), disagree, gains, explained)
