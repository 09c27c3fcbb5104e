"""95 % intervals of the parameters after the calibration."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from pyrofit.diagnose.base.descent import descend, refreshed
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import fraction, model_of, name_of
from pyrofit.diagnose.judge.ridges import Ridge, ridge_of
from pyrofit.effects import known_effects
from pyrofit.estimate.posterior import interval as interval_of
from pyrofit.solver.arrays import FloatArray


def values_of(trial: FittedModel) -> tuple[FloatArray, FloatArray]:
    """Return values and standard deviations in SI units; misfit beyond the noise widens these."""
    problem, fit = trial.model.likelihood.problem, trial.fit
    sd = np.sqrt(np.diag(trial.posterior.covariance())) * (problem.upper - problem.lower)
    return trial.model.likelihood.values(fit.x), sd


def interval(
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


def strengths(trial: FittedModel, wide: Mapping[str, FittedModel]) -> dict[str, Any]:
    """Return the parameters of a model's effects, SI units.

    ``wide`` are the models of `with_all_forms`. They add the interval with an uncertain form. It
    spans two intervals: with the form as it is, and with all form parameters fitted.
    """
    values, sd = values_of(trial)
    catalogue = known_effects()
    found = {}
    for effect, free in trial.model.effects.items():
        for parameter in free:
            name = name_of(effect, parameter)
            own = interval(trial, trial.model.names.index(name), values, sd)
            found[name] = {
                **own,
                "unit": catalogue[effect].quantities[parameter].unit,
                **_with_form(own, wide.get(effect), name),
            }
    return found


def ridges(trial: FittedModel, wide: Mapping[str, FittedModel]) -> list[Ridge]:
    """Return the products of parameters that the data determine, by effect with several."""
    found = []
    for effect in trial.effects:
        model = wide.get(effect, trial)
        free = model.model.effects[effect]
        problem = model.model.likelihood.problem
        at = [model.model.names.index(name_of(effect, parameter)) for parameter in free]
        span = (problem.upper - problem.lower)[at]
        covariance = model.posterior.covariance()[np.ix_(at, at)] * np.outer(span, span)
        found.append(ridge_of(effect, free, values_of(model)[0][at], covariance))
    return [ridge for ridge in found if ridge is not None]


def with_all_forms(trial: FittedModel) -> dict[str, FittedModel]:
    """Return, by effect, the model fitted with all its form parameters free, if it has others."""
    found = {effect: _formed(trial, effect) for effect in trial.effects}
    return {effect: model for effect, model in found.items() if model is not None}


def _with_form(
    own: dict[str, float], wide: FittedModel | None, name: str
) -> dict[str, float | None]:
    """Return the ends of both intervals together, nothing where the effect has no other form."""
    if wide is None:
        return {"low_form": None, "high_form": None}
    other = interval(wide, wide.model.names.index(name), *values_of(wide))
    return {
        "low_form": min(own["low"], other["low"]),
        "high_form": max(own["high"], other["high"]),
    }


def _formed(trial: FittedModel, effect: str) -> FittedModel | None:
    """Return the model fitted with all form parameters of an effect free, if it has others."""
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
    return FittedModel(model, refreshed(model, descend(model, x)))
