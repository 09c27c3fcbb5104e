"""Values that are possible but unusual, most often because of a wrong unit."""

from collections.abc import Iterator

from pyrofit.config.derived import ends_of
from pyrofit.config.study import Study
from pyrofit.model.base import numbers

USUAL: dict[str, tuple[float, float, str]] = {
    "E_J_mol": (2e4, 5e5, "J/mol"),
    "conductivity_W_mK": (0.01, 500.0, "W/(m K)"),
    "density_kg_m3": (1.0, 2.5e4, "kg/m3"),
    "duration_s": (10.0, 1e5, "s"),
    "flux_W_m2": (1e3, 2e5, "W/m2"),
    "gas_temperature_K": (200.0, 1500.0, "K"),
    "h_W_m2K": (0.1, 200.0, "W/(m2 K)"),
    "heat_of_combustion_J_kg": (1e6, 1.5e8, "J/kg"),
    "heating_rate_K_min": (0.1, 1000.0, "K/min"),
    "reference_temperature_K": (300.0, 1500.0, "K"),
    "specific_heat_J_kgK": (100.0, 2e4, "J/(kg K)"),
    "thickness_m": (1e-6, 0.05, "m"),
    "wall_temperature_K": (200.0, 1500.0, "K"),
}
"""Lowest and highest usual value of fire tests on solids, and the unit, by key. Zero is usual."""
MOST_REPETITIONS = 10_000
LONGEST_NAME = 60
CONFUSING = ("nan", "inf", "none", "null", "rest", "true", "false")
"""Names that read like something else in tables and files."""


def unusual(study: Study) -> list[str]:
    """Return one sentence for each unusual value or name; a study is valid in spite of them."""
    return [*_values(study), *_repetitions(study), *_names(study)]


def _values(study: Study) -> Iterator[str]:
    described = {
        "material": study.material,
        **{f"experiments.{name}": one for name, one in study.experiments.items()},
    }
    for root, part in described.items():
        for place, value, _ in numbers(part, root):
            # A number of a property stands one or two keys below it.
            key = next((key for key in reversed(place.split(".")) if key in USUAL), None)
            if key is None or place.split(".")[-1] not in (key, "value"):
                continue
            for what, number in _in_si(study, value):
                low, high, unit = USUAL[key]
                if number and not low <= abs(number) <= high:
                    yield (
                        f"{place}: {what}{number:g} {unit} is outside the usual range of {low:g} "
                        f"to {high:g} {unit}; check the unit"
                    )


def _in_si(study: Study, value: float | str) -> Iterator[tuple[str, float]]:
    """Yield a number, or value and limits of the parameter that stands for it, in SI units."""
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
            what = "value" if word == "value" else f"{word} limit"
            yield f"{what} of parameter '{value}', ", number * parameter.factor


def _repetitions(study: Study) -> Iterator[str]:
    if study.imp.repetitions > MOST_REPETITIONS:
        yield (
            f"imp.repetitions: {study.imp.repetitions:,} repetitions for each cost function are "
            "unusual; 5 to 1000 are usual"
        )


def _names(study: Study) -> Iterator[str]:
    named = [("name", study.name)]
    named += [(f"parameters.{name}", name) for name in study.parameters]
    named += [(f"experiments.{name}", name) for name in study.experiments]
    for place, name in named:
        if len(name) > LONGEST_NAME:
            yield (
                f"{place[:LONGEST_NAME]}...: a name of {len(name)} characters does not fit into "
                f"tables and figures; use at most {LONGEST_NAME}"
            )
        if name.lower() in CONFUSING:
            yield f"{place}: the name '{name}' is easily mistaken for something else; use another"
