"""95 % intervals of the parameters after the calibration."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from pyrofit.diagnose.base.descent import Fit, descend_chi_square, refreshed
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Model, fraction, model_of, name_of
from pyrofit.diagnose.judge.ridges import ridge_of
from pyrofit.effects import known_effects
from pyrofit.estimate.posterior import interval as interval_of
from pyrofit.parallel import parallel_map
from pyrofit.results.diagnosis_candidates import OfRidge, OfStrength
from pyrofit.solver.arrays import FloatArray

Interval = tuple[float, float]


def values_of(trial: FittedModel) -> tuple[FloatArray, FloatArray]:
    """Return values and standard deviations in SI units; misfit beyond the noise widens these."""
    problem, fit = trial.model.likelihood.problem, trial.fit
    sd = np.sqrt(np.diag(trial.posterior.covariance())) * (problem.upper - problem.lower)
    return trial.model.likelihood.values(fit.x), sd


def interval_over_models(
    trial: FittedModel, i: int, values: FloatArray, sd: FloatArray, factor: float = 1.0
) -> dict[str, float]:
    """Return value and 95 % interval of a parameter, within its limits, over ``factor``."""
    problem = trial.model.likelihood.problem
    low, high = interval_of(values[i], sd[i], problem.lower[i], problem.upper[i])
    return {
        "value": float(values[i] / factor),
        "low": float(low / factor),
        "high": float(high / factor),
    }


def strengths(trial: FittedModel, wide: Mapping[str, Interval]) -> dict[str, OfStrength]:
    """Return the parameters of a model's effects, SI units.

    ``wide`` are `wide_intervals`. They are stated where they are wider than those of the model.
    """
    values, sd = values_of(trial)
    catalogue = known_effects()
    found = {}
    for effect, free in trial.model.effects.items():
        for parameter in free:
            name = name_of(effect, parameter)
            own = interval_over_models(trial, trial.model.names.index(name), values, sd)
            ends = own["low"], own["high"]
            wider = wide.get(name, ends)
            low, high = (None, None) if wider == ends else wider
            unit = catalogue[effect].quantities[parameter].unit
            found[name] = OfStrength(**own, unit=unit, low_wide=low, high_wide=high)
    return found


def wide_intervals(models: Iterable[FittedModel]) -> dict[str, Interval]:
    """Return the 95 % intervals of effects' parameters over several models, SI units.

    Each spans the intervals in all models that have the parameter. An effect may replace one effect
    of the final model in one of them, and two in another. The interval in one model takes this
    model as the true one (Draper 1995, doi 10.1111/j.2517-6161.1995.tb02015.x).
    """
    found: dict[str, Interval] = {}
    for model in models:
        values, sd = values_of(model)
        for i in range(len(values) - model.numbers, len(values)):
            own, name = interval_over_models(model, i, values, sd), model.model.names[i]
            low, high = found.get(name, (np.inf, -np.inf))
            found[name] = (min(low, own["low"]), max(high, own["high"]))
    return found


def ridges(trial: FittedModel, formed: Mapping[str, FittedModel]) -> list[OfRidge]:
    """Return the products of parameters that the data determine, by effect with several.

    ``formed`` are the models of `with_all_forms`.
    """
    found, settings = [], trial.settings
    for effect in trial.effects:
        model = formed.get(effect, trial)
        free = model.model.effects[effect]
        problem = model.model.likelihood.problem
        at = [model.model.names.index(name_of(effect, parameter)) for parameter in free]
        span = (problem.upper - problem.lower)[at]
        covariance = model.posterior.covariance()[np.ix_(at, at)] * np.outer(span, span)
        values, least = values_of(model)[0][at], (settings.open_sd, settings.ridge_gain)
        found.append(ridge_of(effect, free, values, covariance, *least))
    return [ridge for ridge in found if ridge is not None]


def with_all_forms(
    trials: Sequence[FittedModel], processes: int = 1
) -> list[dict[str, FittedModel]]:
    """Return of each trial, by effect, the model fitted with all form parameters of the effect.

    Effects without other form parameters are left out.
    """
    begins = [
        (k, effect, *begin)
        for k, trial in enumerate(trials)
        for effect in trial.effects
        if (begin := _formed(trial, effect)) is not None
    ]

    def fitted(i: int) -> Fit:
        _, _, model, x = begins[i]
        return refreshed(model, descend_chi_square(model, x))

    found: list[dict[str, FittedModel]] = [{} for _ in trials]
    fits = parallel_map(fitted, len(begins), processes)
    for (k, effect, model, _), fit in zip(begins, fits, strict=True):
        found[k][effect] = FittedModel(model, fit)
    return found


def _formed(trial: FittedModel, effect: str) -> tuple[Model, FloatArray] | None:
    """Return a model with all form parameters of an effect, and where its fit begins."""
    form = [p for p in known_effects()[effect].form if p not in trial.model.effects[effect]]
    if not form:
        return None
    quantities = known_effects()[effect].quantities
    free = {**trial.model.effects, effect: (*trial.model.effects[effect], *form)}
    model = model_of(trial.model.base, free, trial.model.channels)
    x = np.full(len(model.names), np.nan)
    for name, value in zip(trial.model.names, trial.fit.x, strict=True):
        x[model.names.index(name)] = value
    for parameter in form:
        at = model.names.index(name_of(effect, parameter))
        x[at] = fraction(quantities[parameter], quantities[parameter].value)
    return model, x
