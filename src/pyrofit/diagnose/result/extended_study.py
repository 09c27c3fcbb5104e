"""The study with the effects that the diagnosis found, as keys that can be written and run."""

from collections.abc import Mapping
from typing import Any

from pyrofit.config import Study
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import laboratories_of, model_of, name_of, strength_of
from pyrofit.effects import known_effects

Keys = dict[str, Any]


def extended_keys(
    study: Study, trial: FittedModel, signals: Mapping[tuple[str, str], Keys]
) -> Keys:
    """Return a study's keys with the effects of a fitted model at their fitted strengths.

    Parameters
    ----------
    study
        The study that was diagnosed.
    trial
        The model with effects.
    signals
        Keys that replace those of a signal, by (experiment, signal): where its file lies.
    """
    keys: Keys = study.model_dump(mode="json", exclude_defaults=True)
    catalogue = known_effects()
    titles = ", ".join(catalogue[name].title for name in trial.effects)
    keys["name"] = f"{study.name}_extended"
    keys["title"] = f"{study.title or study.name}, with {titles}"
    keys["effects"] = _effects(trial)
    if study.diagnosis.effects is not None:
        keys["diagnosis"]["effects"] = [n for n in study.diagnosis.effects if _fits(trial, n)]
    for (experiment, signal), given in signals.items():
        keys["experiments"][experiment]["signals"][signal] |= given
    # Computed signals are read from their files now: the truth stays the same.
    files = [s["file"] for e in keys["experiments"].values() for s in e["signals"].values()]
    if "synthetic" not in files:
        keys.pop("synthetic", None)
    return keys


def _fits(trial: FittedModel, effect: str) -> bool:
    """Tell whether a model can have an effect beside its own."""
    try:
        more = {**trial.model.effects, effect: (strength_of(effect)[0],)}
        model_of(trial.model.base, more, trial.model.channels)
    except ValueError:  # both set the same number of the description
        return False
    return effect not in trial.effects


def _effects(trial: FittedModel) -> Keys:
    base, values = trial.model.base, trial.model.likelihood.values(trial.fit.x).tolist()
    fitted = dict(zip(trial.model.names, values, strict=True))
    return {
        effect: {
            **{parameter: fitted[name_of(effect, parameter)] for parameter in free},
            **{key: list(names) for key, names in laboratories_of(base, effect).items()},
        }
        for effect, free in trial.model.effects.items()
    }
