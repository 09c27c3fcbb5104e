"""Rules for the diagnosis of a study."""

from pyrofit.config.check.stages import check_choice, check_estimate
from pyrofit.config.keys.study import Study
from pyrofit.config.resolve import (
    calibrated,
    calibration_channels,
    diagnosed,
    diagnosed_material,
    diagnosed_parameters,
    held_out_channels,
    obstacle,
)
from pyrofit.config.uses import parameters_in
from pyrofit.config.words import require
from pyrofit.effects import known_effects
from pyrofit.errors import suggest


def check_diagnosis(study: Study) -> None:
    """Check signals, parameters and candidates of the diagnosis.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    _check_kinetics(study)
    _check_channels(study)
    _check_parameters(study)
    _check_effects(study)


def _check_channels(study: Study) -> None:
    check_choice(study, "diagnosis.calibrate", study.diagnosis.calibrate)
    check_choice(study, "diagnosis.hold_out", study.diagnosis.hold_out)
    require(
        any(study.serves(name, "imp") for name in calibrated(study)),
        "diagnosis.calibrate",
        "a TGA alone shows nothing of the slab; add a gasification signal",
    )
    fitted = {(c.experiment, c.signal) for c in calibration_channels(study)}
    for c in held_out_channels(study):
        require(
            (c.experiment, c.signal) not in fitted,
            f"diagnosis.hold_out.{c.experiment}",
            f"'{c.signal}' is calibrated, too; leave it out, or list under diagnosis.calibrate "
            "the other signals only",
        )


def _check_kinetics(study: Study) -> None:
    stage = study.kinetics
    choices = ("", "described", *(("fitted", *stage.sets) if stage else ()))
    given = study.diagnosis.kinetics
    require(
        given in choices,
        "diagnosis.kinetics",
        f"unknown kinetics '{given}'. {suggest(given, choices[1:])}",
    )


def _check_parameters(study: Study) -> None:
    material = diagnosed_material(study)
    check_estimate(study, "diagnosis", study.diagnosis.estimate)
    used = parameters_in(material, *calibrated(study).values())
    for name in study.diagnosis.estimate:
        require(
            name in used,
            "diagnosis.estimate",
            f"'{name}' has no effect on any calibrated signal; leave it out",
        )
    given = set(study.fixed_values()) | set(diagnosed_parameters(study))
    for name in sorted(parameters_in(material, *diagnosed(study).values()) - given):
        raise ValueError(
            f"parameters.{name}: the diagnosis needs it; add it to diagnosis.estimate or give a "
            "value"
        )


def _check_effects(study: Study) -> None:
    place = "diagnosis.effects"
    chosen, catalogue = study.diagnosis.effects or (), known_effects()
    require(len(set(chosen)) == len(chosen), place, "a name stands twice; delete one")
    for name in chosen:
        require(name in catalogue, place, f"unknown effect '{name}'. {suggest(name, catalogue)}")
        found = obstacle(study, name)
        require(not found, place, f"'{name}' cannot be a candidate: {found}; leave it out")
    for name, (low, high) in study.diagnosis.plausible.items():
        place = f"diagnosis.plausible.{name}"
        require(name in catalogue, place, f"unknown effect '{name}'. {suggest(name, catalogue)}")
        (strength,) = catalogue[name].strength.values()
        require(
            low <= strength.value <= high and low < high,
            place,
            f"{low:g} to {high:g} must hold the null value {strength.value:g} {strength.unit}",
        )
