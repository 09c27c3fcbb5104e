"""The study with what the diagnosis found, as keys that can be written and run."""

from collections.abc import Mapping
from typing import Any

from pyrofit.config import Study
from pyrofit.diagnose.refit import Trial
from pyrofit.effects import known_effects

Keys = dict[str, Any]


def extended_keys(study: Study, trial: Trial, signals: Mapping[tuple[str, str], Keys]) -> Keys:
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
    for (experiment, signal), given in signals.items():
        keys["experiments"][experiment]["signals"][signal] |= given
    # What was computed once is read from its file now: the truth stays what it was.
    files = [s["file"] for e in keys["experiments"].values() for s in e["signals"].values()]
    if "synthetic" not in files:
        keys.pop("synthetic", None)
    return keys


def _effects(trial: Trial) -> Keys:
    values = trial.model.likelihood.values(trial.fit.x).tolist()
    fitted = dict(zip(trial.model.names, values, strict=True))
    return {
        effect: {parameter: fitted[f"{effect}_{parameter}"] for parameter in free}
        for effect, free in trial.model.effects.items()
    }
