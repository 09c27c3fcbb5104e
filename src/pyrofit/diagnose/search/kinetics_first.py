"""Kinetics from the small samples, before the slab is looked at.

A model of the slab that lacks an effect moves its kinetics to make up for it. Small samples have
too few points to prevent this. The kinetics are therefore fitted to TGA, DSC and MCC alone, with
the effects on them that these records ask for. Their temperature may have an error that a careful
description leaves open. The fit of all signals keeps each parameter within three standard
deviations of this fit. If it rests at such a limit, slab and small samples are in conflict.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.descent import Fit, descend_chi_square
from pyrofit.diagnose.base.fit import fitted_from_starts
from pyrofit.diagnose.base.fitted import FittedModel, polished, up_to_date
from pyrofit.diagnose.base.inflation import by_significant_misfit
from pyrofit.diagnose.base.model import Base, Free, fraction, model_of, strength_of
from pyrofit.diagnose.search.refit import look_at, model_with, with_effect
from pyrofit.diagnose.search.score_test import Screening
from pyrofit.effects import known_effects
from pyrofit.effects.base import has_programme
from pyrofit.numerics import functions
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray


def kinetics_first(
    base: Base, names: Collection[str], candidates: Sequence[str], seed: int, processes: int = 1
) -> Base:
    """Return the base with narrower limits of the kinetics, if small samples stand beside a slab.

    Parameters
    ----------
    base
        All channels with their noise.
    names
        Parameters of the kinetics.
    candidates
        Names of the effects that the study may lack.
    seed
        Seed of the starts.
    processes
        Processes that share the fits.
    """
    small = tuple(i for i in base.calibrated if not base.shows_the_slab(i))
    if not small or len(small) == len(base.calibrated) or not names:
        return base
    alone = replace(base, calibrated=small)
    first, starts = fitted_from_starts(alone, seed, processes)
    first = _with(first, _of_record(candidates))
    return _narrowed(base, names, _explained(first, candidates, starts, processes))


def _of_record(candidates: Sequence[str]) -> list[str]:
    """Return the candidates that belong to the records of small samples, not to the material."""
    effects = known_effects()
    return [
        name
        for name in candidates
        if not effects[name].is_shared and effects[name].needs is has_programme
    ]


def _with(trial: FittedModel, effects: Sequence[str]) -> FittedModel:
    """Return a model fitted with further effects."""
    for effect in effects:
        name, quantity = strength_of(effect)
        free: Free = {**trial.model.effects, effect: (name,)}
        model = model_of(trial.model.base, free, trial.model.channels)
        x = np.append(trial.fit.x, fraction(quantity, quantity.value))
        trial = FittedModel(model, descend_chi_square(model, x))
    return up_to_date(trial)


def _explained(
    trial: FittedModel, candidates: Sequence[str], starts: Sequence[FloatArray], processes: int
) -> list[FittedModel]:
    """Return models with one effect more each, as long as the records ask for it as a claim does.

    Where they ask for none, the model itself.
    """
    spare = 2.0 * float(functions.log(max(len(candidates), 1)))
    found: list[FittedModel] = []
    shown: set[str] = set()
    for _ in range(trial.settings.most_of_kinetics):
        names = [name for name in candidates if name not in trial.effects]
        looks = look_at(trial, names, processes)
        # A reaction of the base may have taken the part of an effect that was shown before.
        shown |= {look.effect for look in looks if look.detectability > 1.0}
        looks = [look for look in looks if look.effect in shown]
        looks = sorted(looks, key=lambda look: float(look.ahead.min()))
        looks = looks[: trial.settings.most_formed]
        if not looks:
            break
        best = _best_with(trial, looks, starts, processes)
        penalised = by_significant_misfit(best).penalised
        if penalised(trial) - penalised(best) < spare:
            break
        trial = up_to_date(best)
        found.append(trial)
    return found or [trial]


def _best_with(
    trial: FittedModel, looks: Sequence[Screening], starts: Sequence[FloatArray], processes: int
) -> FittedModel:
    """Return the best fit with an effect more, from the fit without it and from other starts.

    With another effect, reactions may take other parts.
    """
    settings = trial.settings
    models = [model_with(trial, look.effect) for look in looks]
    begins = [(k, x) for k in range(len(looks)) for x in (None, *starts[: settings.base_descents])]

    def fit(i: int) -> Fit:
        k, x = begins[i]
        if x is None:
            return with_effect(trial, looks[k]).fit
        model, base = models[k], trial.fit.x.size
        whole = np.concatenate([x, trial.fit.x[x.size : base], np.zeros(len(model.names) - base)])
        _, quantity = strength_of(looks[k].effect)
        whole[base] = fraction(quantity, quantity.typical)
        return descend_chi_square(model, whole, enough=settings.rough_gain)

    fits = parallel_map(fit, len(begins), processes)
    found = [FittedModel(models[k], end) for (k, _), end in zip(begins, fits, strict=True)]
    return polished([min(found, key=lambda one: one.penalised)], processes)[0]


def _narrowed(base: Base, names: Collection[str], alone: Sequence[FittedModel]) -> Base:
    """Return the base with limits that hold three standard deviations of each of some fits.

    Misfit that is left widens them. It names the effects of the last fit.
    """
    problem, settings = base.likelihood.problem, base.settings
    count = len(problem.names)
    lowest, highest = np.ones(count), np.zeros(count)
    for trial in alone:
        misfit = max(by_significant_misfit(trial).factors)
        sds = np.sqrt(np.diag(trial.posterior.covariance())[:count] * misfit)
        reach = np.maximum(settings.kinetics_reach * sds, settings.narrowest_kinetics)
        lowest = np.minimum(lowest, np.clip(trial.fit.x[:count] - reach, 0.0, 1.0))
        highest = np.maximum(highest, np.clip(trial.fit.x[:count] + reach, 0.0, 1.0))
    shown = np.any(alone[0].fit.jacobian[: alone[0].model.points] != 0.0, axis=0)[:count]
    of_kinetics = shown & np.isin(problem.names, list(names))
    lower = np.where(of_kinetics, problem.lower + lowest * problem.span, problem.lower)
    upper = np.where(of_kinetics, problem.lower + highest * problem.span, problem.upper)
    narrow = replace(problem, lower=lower, upper=upper)
    asked = [effect for effect in alone[-1].effects if known_effects()[effect].is_shared]
    likelihood = replace(base.likelihood, problem=narrow)
    return replace(base, likelihood=likelihood, of_small_samples=tuple(asked))
