"""Models that were fitted, and fits that are followed further."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.diagnose.base.descent import Fit, descend_chi_square, refreshed
from pyrofit.diagnose.base.model import Model, model_of, strength_of
from pyrofit.diagnose.settings import Settings
from pyrofit.estimate.posterior import Posterior, covariance, limit_of
from pyrofit.numerics import functions
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray

Key = frozenset[tuple[str, tuple[str, ...]]]
"""Names a model: its effects, each with its fitted parameters."""


@dataclass(frozen=True, eq=False)
class FittedModel:
    """A model that was fitted."""

    model: Model
    fit: Fit

    @property
    def settings(self) -> Settings:
        """The numbers that steer its diagnosis."""
        return self.model.base.settings

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of its effects."""
        return tuple(self.model.effects)

    @property
    def key(self) -> Key:
        """Its effects and their fitted parameters."""
        return frozenset(self.model.effects.items())

    @property
    def numbers(self) -> int:
        """How many parameters its effects have."""
        return sum(len(free) for free in self.model.effects.values())

    @property
    def penalised(self) -> float:
        """chi2 + log(n) per parameter of an effect (Schwarz 1978, doi 10.1214/aos/1176344136)."""
        return self.fit.chi2 + self.price

    @property
    def price(self) -> float:
        """log(n) per parameter of an effect."""
        return self.numbers * float(functions.log(self.model.points))

    @property
    def posterior(self) -> Posterior:
        """The parameters about the fit."""
        residuals = self.fit.residuals[: self.model.points]
        jacobian = self.fit.jacobian.copy()
        known = self.model.likelihood.prior
        of_known = slice(self.model.points, self.model.points + len(known.index))
        jacobian[of_known] = known.stated_slopes(self.model.likelihood.problem.span)
        return Posterior(self.fit.x, residuals, jacobian)

    def strength(self, effect: str) -> float:
        """Return the fitted strength of an effect in SI units."""
        values = self.model.likelihood.values(self.fit.x)
        return float(values[self.model.position(effect)])


def followed(trial: FittedModel) -> FittedModel:
    """Return a rough fit followed to its end."""
    return lower_of(trial, descend_chi_square(trial.model, trial.fit.x, trial.fit.jacobian))


def lower_of(trial: FittedModel, end: Fit) -> FittedModel:
    """Return a trial with another end where that is lower."""
    return replace(trial, fit=end) if end.chi2 < trial.fit.chi2 else trial


def up_to_date(trial: FittedModel) -> FittedModel:
    """Return a trial with derivatives made at its end."""
    return replace(trial, fit=refreshed(trial.model, trial.fit))


def all_up_to_date(trials: Sequence[FittedModel], processes: int = 1) -> list[FittedModel]:
    """Return trials with derivatives made at their ends."""
    found = list(trials)
    old = [k for k, trial in enumerate(trials) if not trial.fit.fresh]
    fits = parallel_map(
        lambda i: refreshed(trials[old[i]].model, trials[old[i]].fit), len(old), processes
    )
    for k, fit in zip(old, fits, strict=True):
        found[k] = replace(trials[k], fit=fit)
    return found


def polished(trials: Sequence[FittedModel], processes: int = 1) -> list[FittedModel]:
    """Fit again from other values of hardly determined parameters; keep the lower fits.

    A parameter at a limit, or one of wide uncertainty, may be in the wrong of several valleys.
    """
    if not trials:
        return []
    settings = trials[0].settings
    found = all_up_to_date(trials, processes)
    lowered = list(range(len(found)))
    for _ in range(settings.most_polishing_rounds):
        begins = [(k, x) for k in lowered for x in _elsewhere(found[k])]
        before = [trial.fit.chi2 for trial in found]
        ends = _ends([(found[k], x) for k, x in begins], processes)
        for (k, _), end in zip(begins, ends, strict=True):
            found[k] = lower_of(found[k], end)
        found = all_up_to_date(found, processes)
        lowered = [k for k in lowered if found[k].fit.chi2 < before[k] - settings.same_valley]
    return found


def _ends(begins: Sequence[tuple[FittedModel, FloatArray]], processes: int) -> list[Fit]:
    return parallel_map(lambda i: _from(*begins[i]), len(begins), processes)


def _from(trial: FittedModel, x: FloatArray) -> Fit:
    """Return where a rough descent from x ends, followed to its end if it ends lower."""
    begin, rough = trial.fit.jacobian, trial.settings.rough_gain
    end = descend_chi_square(trial.model, x, begin, enough=rough, known=trial.fit)
    return followed(replace(trial, fit=end)).fit if end.chi2 < trial.fit.chi2 else end


def _elsewhere(trial: FittedModel) -> Iterator[FloatArray]:
    """Yield the fit with a parameter moved that is hardly determined or rests at a limit.

    A parameter with a known value is not searched elsewhere, as that value tells its place.
    """
    best, settings = trial.fit, trial.settings
    wide = np.sqrt(np.diag(covariance(best.jacobian))) > settings.wide_sd
    resting = (best.x <= 0.0) | (best.x >= 1.0)
    # Uncertain parameters of held-out experiments change nothing here.
    shown = np.any(best.jacobian[: trial.model.points] != 0.0, axis=0)
    moved = (wide & shown) | resting
    moved[list(trial.model.likelihood.prior.index)] = False
    for i in np.flatnonzero(moved[: len(trial.model.names) - trial.numbers]):
        for value in settings.elsewhere:
            if abs(value - best.x[i]) > settings.apart:
                x = best.x.copy()
                x[i] = value
                yield x


def finishes(trial: FittedModel) -> bool:
    """Tell whether the runs of all held-out signals finish with a fitted model."""
    base = trial.model.base
    if not base.held_out:
        return True
    held_out = model_of(base, trial.model.effects, base.held_out)
    return held_out.likelihood.curves(trial.fit.x) is not None


def misfits_badly(trial: FittedModel) -> bool:
    """Tell whether a signal misfits so much that its misfit was not mistaken for noise."""
    parts = trial.model.by_channel(trial.fit.residuals)
    most = trial.settings.misfit_chi2_per_point
    return any(float(np.mean(part**2)) > most for part in parts)


def at_limit(trial: FittedModel, effect: str) -> str:
    """Return the name of an effect's strength if it rests at a limit, else nothing.

    A strength of zero is a state, not a limit, if its null value is above zero: an insulated back
    is an example. A form may rest at a limit: a step may be sharper than the data can show.
    """
    x = trial.fit.x[trial.model.position(effect)]
    _, quantity = strength_of(effect)
    side = limit_of(x)
    absent = side == "lower" and quantity.lower == 0.0 < quantity.value
    return trial.model.names[trial.model.position(effect)] if side and not absent else ""


def resting_at_limits(trial: FittedModel) -> list[str]:
    """Return the names of the parameters at a limit that a calibrated signal shows."""
    idle = trial.model.idle
    places = enumerate(zip(trial.model.names, trial.fit.x.tolist(), strict=True))
    return [name for i, (name, x) in places if i not in idle and limit_of(x)]


def implausible(trial: FittedModel, effect: str) -> float:
    """Return by how many standard deviations a strength is not plausible, 0 where it is."""
    plausible = trial.model.base.plausible.get(effect)
    return plausible.far(trial.strength(effect)) if plausible else 0.0


def strengths_at_limit(trial: FittedModel) -> list[str]:
    """Return the names of all strengths that rest at a limit."""
    return [name for effect in trial.effects if (name := at_limit(trial, effect))]
