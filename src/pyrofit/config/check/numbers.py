"""Rules for the numbers of a study: signs, limits, units, and that each is used."""

from collections.abc import Sequence

from pyrofit.config.check.expressions import check_expression
from pyrofit.config.keys.study import Study
from pyrofit.config.uses import names_in, parameters_in
from pyrofit.config.words import require
from pyrofit.errors import suggest
from pyrofit.model.base import Part, Rule, numbers
from pyrofit.model.parameters import UNITS

# By the end of a key, longest first where one end is that of another.
_UNITS: dict[str, tuple[str, ...]] = {
    "_kg_m3": ("kg/m3",),
    "_W_mK": ("W/(m K)",),
    "_J_kgK": ("J/(kg K)", "kJ/(kg K)"),
    "_J_kg": ("J/kg", "kJ/kg"),
    "_W_kgK": ("W/(kg K)",),
    "_W_kg": ("W/kg", "W/g"),
    "_J_mol": ("J/mol", "kJ/mol", "kJ/kmol"),
    "_W_m2K43": ("W/(m2 K^(4/3))",),
    "_W_m2K": ("W/(m2 K)",),
    "_W_m2": ("W/m2", "kW/m2"),
    "_m2K_W": ("m2 K/W",),
    "_1_K": ("1/K",),
    "_1_s": ("1/s",),
    "_1_m": ("1/m",),
    "_s": ("s",),
    "_K": ("K",),
    "_m": ("m", "mm"),
    "emissivity_depth": ("m", "mm"),
    "scale": tuple(UNITS),
    "bend": ("1/K", "kg/J"),
    "": ("-",),
}
_SHARES = ("products", "composition", "beside")
_SAME_UNIT = ("value", "of", "step")
"""Keys of a property whose unit is the property's."""


def parts_with_numbers(study: Study) -> dict[str, Part]:
    """Return the parts of a study that hold numbers, by their place."""
    experiments = {f"experiments.{name}": e for name, e in study.experiments.items()}
    return {"material": study.material, **experiments}


def check_numbers(study: Study) -> None:
    """Check every number of material and experiments, and every parameter that stands for one.

    Raises
    ------
    ValueError
        A number, or a value or limit of the parameter in its place, breaks the rule of the place.
        The parameter is unknown, or its unit is that of another quantity.
    """
    for root, part in parts_with_numbers(study).items():
        for place, value, rules in numbers(part, root):
            if isinstance(value, str) and not value.isidentifier():
                check_expression(study, value, rules, place)
                continue
            if isinstance(value, str):
                check_entry(study, value, rules, place)
                continue
            for rule in rules:
                require(rule.holds(value), place, f"{value:g} {rule.text}")


def check_entry(study: Study, name: str, rules: Sequence[Rule], place: str) -> None:
    """Check the entry for a number: that there is one, its value and limits, its unit.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    require(
        name in study.parameters,
        place,
        f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
    )
    p = study.parameters[name]
    given = {f"parameters.{name}.{key}": getattr(p, key) for key in ("value", "lower", "upper")}
    if study.synthetic is not None:
        given[f"synthetic.truth.{name}"] = study.synthetic.truth.get(name)
    for where, number in given.items():
        for rule in rules:
            require(
                number is None or rule.holds(number * p.factor),
                where,
                f"{number} {rule.text} (it is used as {place})",
            )
    fitting = _units_of_offset(study, place) or units_of(place)
    require(
        p.unit in fitting,
        f"parameters.{name}.unit",
        f"'{p.unit}' is no unit of {place}, where it is used; give {' or '.join(fitting)}",
    )


def _units_of_offset(study: Study, place: str) -> tuple[str, ...]:
    """Return the units that fit the offset of a signal; none where the place is another."""
    match place.split("."):
        case ["experiments", name, "signals", signal, "offset"]:
            return (study.experiments[name].quantity(signal).unit,)
    return ()


def units_of(place: str) -> tuple[str, ...]:
    """Return the units that fit the number at a place of the description.

    >>> units_of("material.components.wood.conductivity_W_mK.value")
    ('W/(m K)',)
    """
    keys = [key for key in place.split(".") if not key.isdigit() and key not in _SAME_UNIT]
    if keys[-1] == "peak_area":
        return _UNITS["_J_kg"] if keys[-2].endswith("_J_kgK") else _UNITS[""]
    if keys[-1] in _SHARES or keys[-2] in _SHARES:
        return _UNITS[""]
    return next(units for end, units in _UNITS.items() if keys[-1].endswith(end))


def alike_units(unit: str) -> tuple[str, ...]:
    """Return the units of the same quantity as a unit, itself among them.

    >>> alike_units("kJ/kg")
    ('J/kg', 'kJ/kg')
    """
    groups = (units for end, units in _UNITS.items() if unit in units and end != "scale")
    return next(groups, (unit,))


def check_parameters(study: Study) -> None:
    """Refuse values and truths outside their limits, and parameters that nothing uses.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    sets = study.kinetics.sets.values() if study.kinetics else ()
    used = parameters_in(study.material, *study.experiments.values())
    used |= {name for chosen in sets for name in names_in(chosen.composition)}
    truth = study.synthetic.truth if study.synthetic else {}
    for name, p in study.parameters.items():
        require(
            name in used or p.expression is not None,
            f"parameters.{name}",
            "nothing uses it; put its name where its number belongs, or delete it",
        )
        if p.lower is None or p.upper is None:
            continue
        for place, value in (
            (f"parameters.{name}.value", p.value),
            (f"synthetic.truth.{name}", truth.get(name)),
        ):
            require(
                value is None or p.lower <= value <= p.upper,
                place,
                f"{value} lies outside the limits {p.lower:g} to {p.upper:g}; "
                "correct it or widen them",
            )
