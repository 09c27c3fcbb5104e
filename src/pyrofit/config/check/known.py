"""Rules for the known values of a study."""

from pyrofit.config.keys.study import Study
from pyrofit.config.resolve import diagnosed_parameters
from pyrofit.config.words import require
from pyrofit.errors import suggest


def check_known(study: Study) -> None:
    """Check that each known value is one of an estimated parameter, within its limits.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    estimated = {*study.imp.estimate, *diagnosed_parameters(study)}
    estimated |= set(study.kinetics.estimate) if study.kinetics else set()
    for name, known in study.known.items():
        place = f"known.{name}"
        require(
            name in study.parameters,
            place,
            f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
        )
        require(
            name in estimated,
            place,
            "no stage estimates it, it has a fixed value. Name it under kinetics.estimate, "
            "imp.estimate or diagnosis.estimate, give it limits, or leave it out here",
        )
        p = study.parameters[name]
        assert p.lower is not None
        assert p.upper is not None
        require(
            p.lower <= known.value <= p.upper,
            f"{place}.value",
            f"{known.value:g} lies outside the limits {p.lower:g} to {p.upper:g}; correct it or "
            "widen them",
        )
