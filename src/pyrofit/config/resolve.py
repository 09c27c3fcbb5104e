"""Defaults of the diagnosis: its signals, parameters and effects."""

from collections.abc import Mapping

from pyrofit.config.keys.stages import Kinetics
from pyrofit.config.keys.study import Study
from pyrofit.config.keys.terms import TermSpec
from pyrofit.config.uses import parameters_in
from pyrofit.effects import known_effects
from pyrofit.effects.apply import own_laboratories, with_effects
from pyrofit.errors import StudyError
from pyrofit.experiments import kind_of
from pyrofit.model.experiment import Experiment
from pyrofit.model.external import ExternalExperiment
from pyrofit.model.material import Material

Chosen = Mapping[str, tuple[str, ...]]
"""Signals by experiment."""
Experiments = dict[str, Experiment]


def kinetics_of(study: Study) -> Kinetics:
    """Return the kinetics stage.

    Raises
    ------
    StudyError
        The study has none.
    """
    if study.kinetics is None:
        raise StudyError(f"study '{study.name}' has no kinetics stage; add `kinetics:` to it")
    return study.kinetics


def diagnosed_material(study: Study) -> Material:
    """Return the material with the kinetics that the diagnosis starts from."""
    return study.material_with(_kinetics(study))


def _kinetics(study: Study) -> str:
    return study.diagnosis.kinetics or study.imp.kinetics


def calibration_channels(study: Study) -> tuple[TermSpec, ...]:
    """Return the signals that the diagnosis fits, each once, all measured points."""
    if study.diagnosis.calibrate:
        return _whole(study.diagnosis.calibrate)
    kinetics = study.kinetics
    # Nothing would be fitted to a TGA whose kinetics are published ones.
    if kinetics is None or _kinetics(study) in kinetics.sets:
        return study.imp.channels
    return kinetics.channels + study.imp.channels


def held_out_channels(study: Study) -> tuple[TermSpec, ...]:
    """Return the signals that the diagnosis predicts only, all measured points."""
    if study.diagnosis.hold_out:
        return _whole(study.diagnosis.hold_out)
    fitted = {(c.experiment, c.signal) for c in calibration_channels(study)}
    return _whole(
        {
            name: tuple(s for s in study.experiments[name].signals if (name, s) not in fitted)
            for name in study.validation.experiments
        }
    )


def _whole(chosen: Chosen) -> tuple[TermSpec, ...]:
    pairs = [(e, s) for e, signals in chosen.items() for s in signals]
    return tuple(TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in pairs)


def diagnosed_parameters(study: Study) -> tuple[str, ...]:
    """Return the names of the parameters that the diagnosis estimates beside the effects."""
    differing = nuisances_of_tests(study)
    if study.diagnosis.estimate:
        return tuple(dict.fromkeys(study.diagnosis.estimate + differing))
    kinetics = study.kinetics.estimate if study.kinetics else ()
    if not any(kind_of(e).stage == "kinetics" for e in calibrated(study).values()):
        kinetics = tuple(name for name in kinetics if study.parameters[name].value is None)
    names = kinetics + study.imp.estimate + differing + _known_beside(study)
    used = parameters_in(diagnosed_material(study), *diagnosed(study).values())
    return tuple(name for name in dict.fromkeys(names) if name in used)


def nuisances_of_tests(study: Study) -> tuple[str, ...]:
    """Return the parameters by which single tests of the diagnosis differ, as their thickness."""
    repeats = (e.repeat for e in diagnosed(study).values() if e.repeat)
    return tuple(name for repeat in repeats for name in repeat.nuisances.values())


def _known_beside(study: Study) -> tuple[str, ...]:
    """Return the parameters that are known only within limits, and that no other stage fits."""
    others = {*study.imp.estimate, *(study.kinetics.estimate if study.kinetics else ())}
    limited = (n for n, p in study.parameters.items() if p.lower is not None)
    return tuple(n for n in limited if n in study.known and n not in others)


def candidate_effects(study: Study) -> tuple[str, ...]:
    """Return the names of the effects that the diagnosis considers."""
    if study.diagnosis.effects is not None:
        return study.diagnosis.effects
    if any(isinstance(e, ExternalExperiment) for e in diagnosed(study).values()):
        return ()  # no effect changes the model of an external program
    return tuple(name for name in known_effects() if not obstacle(study, name))


def obstacle(study: Study, name: str) -> str:
    """Say why an effect of the catalogue is no candidate; nothing where it is one."""
    effect = known_effects()[name]
    if name in study.with_effects:
        return "the model has it already"
    if not any(effect.needs(e) for e in calibrated(study).values()):
        return f"no calibrated signal can show it; it needs {effect.needs.words}"
    distinct = effect.distinct_in
    if distinct and not any(distinct(e) for e in calibrated(study).values()):
        return f"it is the same model as another of its group; it needs {distinct.words}"
    every = diagnosed(study)
    own = {} if effect.is_shared else own_laboratories(calibrated(study).values(), every.values())
    free = {key: f"{name}_{key}" for key in effect.strength}
    try:
        with_effects(diagnosed_material(study), every, {name: {**free, **own}})
    except ValueError as error:
        return str(error).removeprefix(f"effect '{name}': ")
    return ""


def calibrated(study: Study) -> Experiments:
    """Return the fitted experiments with those of their signals that are fitted."""
    signals: dict[str, dict[str, object]] = {}
    for c in calibration_channels(study):
        signal = study.experiments[c.experiment].signals[c.signal]
        signals.setdefault(c.experiment, {})[c.signal] = signal
    return {
        name: study.experiments[name].model_copy(update={"signals": of})
        for name, of in signals.items()
    }


def diagnosed(study: Study) -> Experiments:
    """Return the experiments that the diagnosis fits or predicts."""
    channels = calibration_channels(study) + held_out_channels(study)
    return {c.experiment: study.experiments[c.experiment] for c in channels}
