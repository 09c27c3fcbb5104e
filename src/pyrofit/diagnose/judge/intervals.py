"""What the calibration leaves of each parameter: 95 % intervals."""

from dataclasses import replace
from typing import Any

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import fraction, model_of, name_of
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


def strengths(trial: FittedModel, with_form: bool) -> dict[str, Any]:
    """Return the parameters of a model's effects, SI units.

    ``with_form`` adds the interval that the strength has with the effect's form as uncertain as the
    limits of its form parameters.
    """
    values, sd = values_of(trial)
    catalogue = known_effects()
    found = {}
    for effect, free in trial.model.effects.items():
        for parameter in free:
            name = name_of(effect, parameter)
            i = trial.model.names.index(name)
            found[name] = {
                **interval(trial, i, values, sd),
                "unit": catalogue[effect].quantities[parameter].unit,
                **(_with_form(trial, effect, i) if with_form else _NO_FORM),
            }
    return found


_NO_FORM: dict[str, float | None] = {"low_form": None, "high_form": None}


def _with_form(trial: FittedModel, effect: str, i: int) -> dict[str, float | None]:
    """Return the 95 % interval with the effect's form as uncertain as its limits."""
    form = [p for p in known_effects()[effect].form if p not in trial.model.effects[effect]]
    if not form:
        return _NO_FORM
    quantities = known_effects()[effect].quantities
    free = {**trial.model.effects, effect: (*trial.model.effects[effect], *form)}
    model = model_of(trial.model.base, free, trial.model.channels)
    x = np.full(len(model.names), np.nan)
    for name, value in zip(trial.model.names, trial.fit.x, strict=True):
        x[model.names.index(name)] = value
    for parameter in form:
        at = model.names.index(name_of(effect, parameter))
        x[at] = fraction(quantities[parameter], quantities[parameter].value)
    jacobian = model.jacobian(x, model.residuals(x))
    wide = FittedModel(model, replace(trial.fit, x=x, jacobian=jacobian))
    at = model.names.index(trial.model.names[i])
    found = interval(wide, at, *values_of(wide))
    return {"low_form": found["low"], "high_form": found["high"]}
