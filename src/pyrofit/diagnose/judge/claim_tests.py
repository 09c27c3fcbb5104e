"""Tests of a claim besides its gain: limits, agreement of experiments, prediction.

A model that still misfits makes every test statistic too large. Each signal's noise then counts
with the variance of `inflation`. The largest factor of the predicted signals divides the gain of a
log score.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.stats import chi2 as chi_squared

from pyrofit.diagnose.base.adequacy import lack_of_fit
from pyrofit.diagnose.base.fit import refitted, with_noise_about
from pyrofit.diagnose.base.fitted import FittedModel, at_limit, implausible
from pyrofit.diagnose.base.inflation import Inflation
from pyrofit.diagnose.base.long_run import long_run_factor
from pyrofit.diagnose.base.prediction import HELD_OUT, Predictions
from pyrofit.diagnose.judge.power import expected_gain
from pyrofit.diagnose.settings import Settings
from pyrofit.estimate.projection import project, projector
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True)
class Trust:
    """Evidence for or against an effect besides the calibration."""

    limit: str
    """The effect's strength if it rests at a limit, or empty."""
    disagree: float | None
    """Probability that equal strengths look as different between experiments. None where fewer than
    two show the effect."""
    gains: dict[str, float]
    """Gain of the log score, by experiments left out or held out."""
    explains: bool | None
    """Whether the model fits the held-out signals as well, if they are fitted, too. None if not
    tested, because it leaves more than noise of the calibrated signals."""
    powers: dict[str, float] = field(default_factory=dict)
    """Expected gain of each prediction if the effect is real; without one, it can tell."""
    conflict: tuple[str, ...] = ()
    """Parameters of known value that the effect must move away to gain enough."""
    implausible: float = 0.0
    """Standard deviations by which the strength is not plausible, 0 where it is."""
    wrong_instead: tuple[str, ...] = ()
    """Parameters whose known values, if wrong, would explain as much as the effect."""
    known: dict[str, tuple[float, float]] = field(default_factory=dict)
    """Known parameters less known values without and with the effect, in standard deviations."""
    settings: Settings = Settings()
    """The numbers that steer the diagnosis."""

    @property
    def telling(self) -> dict[str, float]:
        """Gains of the predictions that can tell the models apart."""
        least = self.settings.informative_gain
        return {n: gain for n, gain in self.gains.items() if self.powers.get(n, least) >= least}

    @property
    def informative(self) -> bool:
        """Whether some prediction distinguishes the models."""
        return any(abs(gain) >= self.settings.informative_gain for gain in self.telling.values())

    @property
    def predicts(self) -> bool:
        """Whether predictions improve on the whole, and none gets clearly worse.

        One held-out experiment alone does not decide against several others: its apparatus may be
        the reason.
        """
        if self.outvoted:
            return True
        return not self.worse and sum(self.telling.values()) >= self.settings.informative_gain

    @property
    def worse(self) -> list[str]:
        """Predictions that get clearly worse, of those that can decide alone."""
        least = self.settings.deciding_gain
        deciding = [n for n in self.gains if self.powers.get(n, least) >= least]
        return [n for n in deciding if self.gains[n] <= -self.settings.informative_gain]

    @property
    def outvoted(self) -> bool:
        """Whether one held-out experiment alone gets worse, and several predictions improve."""
        least = self.settings.informative_gain
        better = [name for name, gain in self.telling.items() if gain >= least]
        return len(self.worse) == 1 and self.worse[0] in self.held_out and len(better) > 1

    @property
    def confirmed(self) -> bool:
        """Whether predictions improve and held-out signals, if any, gain enough by themselves."""
        enough = self.held_out_gain >= self.settings.informative_gain
        return self.predicts and (not self.held_out or enough)

    @property
    def held_out_gain(self) -> float:
        """Gain of the log score of held-out signals together, without one that is outvoted."""
        out = self.worse if self.outvoted else []
        return sum(gain for name, gain in self.held_out.items() if name not in out)

    @property
    def held_out(self) -> dict[str, float]:
        """Gains of the log score of held-out signals that can tell."""
        return {n: gain for n, gain in self.telling.items() if n.startswith(HELD_OUT)}


def disagreement(trial: FittedModel, effect: str, inflation: Inflation) -> float | None:
    """Return the probability that a strength common to all experiments looks as different.

    None where fewer than two experiments show the effect. Of an effect that small samples ask for,
    small samples alone are compared.

    Score test: the columns of d w/d strength, one experiment each, against the fit's residuals.
    The noise has the variance of ``inflation``, and the parameters make one step to fit under it.
    """
    rows = inflation.rows(trial)
    model = trial.model
    fit = replace(
        trial.fit,
        residuals=rows * trial.fit.residuals,
        slopes=rows[:, None] * trial.fit.jacobian,
    )
    column = fit.jacobian[: model.points, model.position(effect)]
    base = model.base
    owners = [base.channels[i][0] for i in model.channels]
    parts = np.split(column, np.cumsum(model.likelihood.points)[:-1])
    judging = [base.channels[i][0] for i in model.channels if _judges(trial, effect, [i])]
    moved = [o for o in dict.fromkeys(judging) if _size(parts, owners, o) > 1e-9]
    if len(moved) < 2:
        return None
    d = np.zeros((fit.residuals.size, len(moved) - 1))
    for k, experiment in enumerate(moved[1:]):
        own = [p if o == experiment else 0.0 * p for p, o in zip(parts, owners, strict=True)]
        d[: model.points, k] = np.concatenate(own)
    d = project(projector(fit), d)
    found = linear.least_squares(d, fit.residuals, least=1e-8)
    fall = linear.dot(fit.residuals, linear.product(d, found))
    return float(chi_squared.sf(fall, len(moved) - 1))


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


def _judges(trial: FittedModel, effect: str, channels: Sequence[int]) -> bool:
    """Tell whether predicted channels judge an effect.

    Small samples alone judge an effect that they ask for by themselves: what is missing from the
    model of the slab may speak against it there.
    """
    base = trial.model.base
    if effect not in base.of_small_samples:
        return True
    return not any(map(base.shows_the_slab, channels))


def trust(
    trial: FittedModel,
    effect: str,
    own: Predictions,
    without: Predictions,
    explained: bool | None,
    inflation: Inflation,
    conflict: Sequence[str] = (),
) -> Trust:
    """Return the evidence for or against an effect of a model.

    Parameters
    ----------
    own, without
        Predictions of the model with and without the effect.
    explained
        Whether it fits held-out signals, too.
    inflation
        By how much the end's misfit raises the variance of the noise.
    conflict
        Known values that the effect must move away, see `pyrofit.diagnose.judge.accord`.
    """
    gains, powers = {}, {}
    judging = [name for name in without.scores if _judges(trial, effect, own.channels[name])]
    # Without a predicted small sample, the slabs judge the effects of these, too.
    for name in judging or without.scores:
        before = without.scores[name]
        # With a noise whose variance is larger by a factor, the gain of a log score is smaller by
        # it. The settings ask for the same gain of all: odds of 7 to 1 after this division.
        both = [max(map(long_run_factor, of.residuals[name])) for of in (own, without)]
        factor = min(both) if inflation.inflates else 1.0
        gains[name] = (own.scores[name] - before) / factor
        powers[name] = expected_gain(own, without, name) / factor
    disagree, far = disagreement(trial, effect, inflation), implausible(trial, effect)
    limit = at_limit(trial, effect)
    return Trust(
        limit, disagree, gains, explained, powers, tuple(conflict), far, settings=trial.settings
    )
