"""Values that are possible but unusual, most often because of a wrong unit."""

from collections.abc import Iterator, Mapping
from itertools import dropwhile
from math import isfinite

from pyrofit.config.check.cold import cold_reactions
from pyrofit.config.check.expressions import ends_of
from pyrofit.config.check.oxidised import oxidised
from pyrofit.config.keys.study import Study
from pyrofit.model.base import Part
from pyrofit.model.properties import Table

USUAL: dict[str, tuple[float, float, str]] = {
    "E_J_mol": (2e4, 5e5, "J/mol"),
    "conductivity_W_mK": (0.01, 500.0, "W/(m K)"),
    "density_kg_m3": (1.0, 2.5e4, "kg/m3"),
    "duration_s": (10.0, 1e5, "s"),
    "emissivity": (0.01, 1.0, "-"),
    "flux_W_m2": (1e3, 2e5, "W/m2"),
    "foil.thickness_m": (1e-6, 0.002, "m"),
    "gas_temperature_K": (200.0, 1500.0, "K"),
    "h_W_m2K": (0.1, 200.0, "W/(m2 K)"),
    "heat_of_combustion_J_kg": (1e6, 1.5e8, "J/kg"),
    "heat_of_reaction_J_kg": (1e4, 3.5e7, "J/kg"),
    "heating_rate_K_min": (0.1, 1000.0, "K/min"),
    "reference_temperature_K": (250.0, 1500.0, "K"),
    "specific_heat_J_kgK": (100.0, 2e4, "J/(kg K)"),
    "thickness_m": (1e-6, 0.05, "m"),
    "wall_temperature_K": (200.0, 1500.0, "K"),
}
"""Lowest and highest usual value of fire tests on solids, and the unit, by key. Zero is usual.

A key with a dot is one of the part before the dot."""
COUNTS: dict[str, tuple[int, str]] = {
    "generations": (10_000, "20 to 500"),
    "repetitions": (10_000, "5 to 1000"),
    "starts": (1000, "2 to 50"),
}
"""The largest count that gives no warning, and the usual counts, by key of a search."""
LONGEST_NAME = 60
CONFUSING = ("nan", "na", "inf", "none", "null", "rest", "true", "false")
"""Names that read like something else in tables and files."""
_WITHIN = ("value", "of")
"""Keys of a property or a table below which its number stands."""
_TEXTS = ("placeholders",)
"""Keys below which texts of another program stand, whatever their names are."""
Number = int | float | str


def unusual_values(study: Study) -> list[str]:
    """Return one sentence for each unusual value or name; a study is valid in spite of them."""
    return [
        *_values(study),
        *cold_reactions(study),
        *oxidised(study),
        *_counts(study),
        *_names(study),
    ]


def _values(study: Study) -> Iterator[str]:
    described = {"material": study.material, "experiments": study.experiments}
    for place, given in _numbers(described, ""):
        key = _key(place)
        if key is None:
            continue
        low, high, unit = USUAL[key]
        for words, number in _in_si(study, given):
            if number and not low <= abs(number) <= high:
                yield (
                    f"{place}: {words}{number:g} {unit} is outside the usual range of {low:g} "
                    f"to {high:g} {unit}; check the unit"
                )


def _numbers(part: object, place: str) -> Iterator[tuple[str, tuple[Number, ...]]]:
    """Yield the place of each number, and the number, or all of a list, as one tuple."""
    if isinstance(part, Table):
        yield place, tuple(_product(value, part.factor) for value in part.value)
    elif isinstance(part, Part):
        for name in type(part).model_fields:
            if name not in _TEXTS:
                yield from _numbers(getattr(part, name), f"{place}.{name}")
    elif isinstance(part, Mapping):
        for name, item in part.items():
            yield from _numbers(item, f"{place}.{name}".lstrip("."))
    elif isinstance(part, tuple):
        if alone := tuple(item for item in part if isinstance(item, Number)):
            yield place, alone
        for i, item in enumerate(part):
            if not isinstance(item, Number):
                yield from _numbers(item, f"{place}.{i}")
    elif isinstance(part, Number):
        yield place, (part,)


def _product(value: Number, factor: Number) -> Number:
    """Return a value of a table times the factor of the table.

    >>> _product(0.2, 2.0), _product(0.2, "f")
    (0.4, '(0.2) * (f)')
    """
    if not isinstance(value, str) and not isinstance(factor, str):
        return value * factor
    return value if factor == 1.0 else f"({value}) * ({factor})"


def _key(place: str) -> str | None:
    """Return the key of the usual range of a place: the last one that is no index or form.

    >>> _key("experiments.a.front.flux_W_m2.value"), _key("experiments.a.sample.foil.thickness_m")
    ('flux_W_m2', 'foil.thickness_m')
    """
    path = place.split(".")
    keys = list(dropwhile(lambda key: key.isdigit() or key in _WITHIN, reversed(path)))
    ends = (".".join(reversed(keys[:count])) for count in (2, 1))
    return next((end for end in ends if end in USUAL), None)


def _in_si(study: Study, given: tuple[Number, ...]) -> Iterator[tuple[str, float]]:
    """Yield a number, or value and limits of the parameter that stands for it, in SI units.

    Of several numbers it is the largest one, as a table may begin with small values.
    """
    if len(given) > 1:
        ends = (abs(end) for number in given for end in _ends(study, number))
        yield "largest value, ", max((end for end in ends if isfinite(end)), default=0.0)
        return
    (value,) = given
    if not isinstance(value, str):
        yield "", value
        return
    if not value.isidentifier():
        yield from ((f"value of '{value}', ", number) for number in ends_of(study, value))
        return
    parameter = study.parameters[value]
    for word in ("value", "lower", "upper"):
        number = getattr(parameter, word)
        if number is not None:
            described = "value" if word == "value" else f"{word} limit"
            yield f"{described} of parameter '{value}', ", number * parameter.factor


def _ends(study: Study, number: Number) -> list[float]:
    return ends_of(study, number) if isinstance(number, str) else [number]


def _counts(study: Study) -> Iterator[str]:
    stages = {"kinetics": study.kinetics, "imp": study.imp}
    for place, given in _numbers(stages, ""):
        key = place.rpartition(".")[2]
        (count, *_) = given
        if key in COUNTS and isinstance(count, int) and count > COUNTS[key][0]:
            yield f"{place}: {count:,} {key} are unusual; {COUNTS[key][1]} are usual"


def _names(study: Study) -> Iterator[str]:
    named = [("name", study.name)]
    named += [(f"parameters.{name}", name) for name in study.parameters]
    named += [(f"experiments.{name}", name) for name in study.experiments]
    for place, name in named:
        if len(name) > LONGEST_NAME:
            dots = "..." if len(place) > LONGEST_NAME else ""
            yield (
                f"{place[:LONGEST_NAME]}{dots}: a name of {len(name)} characters does not fit "
                f"into tables and figures; use at most {LONGEST_NAME}"
            )
        if name.lower() in CONFUSING:
            yield f"{place}: the name '{name}' is easily mistaken for something else; use another"
