"""Base of every part of a description: frozen, checked, numbers with rules."""

import math
from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Self, TypeVar, cast

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, PrivateAttr, model_validator

from pyrofit.errors import suggest
from pyrofit.model.expressions import names_of, value_of_expression

Made = TypeVar("Made")


class Part(BaseModel):
    """A frozen piece of a description; unknown keys are errors that name the nearest one."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    INHERITS: ClassVar[frozenset[str]] = frozenset()
    """Fields whose numbers obey the rules of the place at which the part stands, too."""
    _derived: dict[Hashable, Any] = PrivateAttr(default_factory=dict)

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self.__dict__ == other.__dict__

    def derived(self, name: Hashable, make: Callable[[Self], Made]) -> Made:
        """Return ``make(self)``, made once: a part never changes."""
        # Not `self._derived`: pydantic looks a private attribute up in ten times the time.
        made: dict[Hashable, Made] = self.__pydantic_private__["_derived"]  # type: ignore[index]
        if name not in made:
            made[name] = make(self)
        return made[name]

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy with some values changed; nothing derived is taken over."""
        copy = super().model_copy(update=update, deep=deep)
        copy._derived = {}
        return copy

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, given: Any) -> Any:
        if isinstance(given, dict):
            for key in given:
                if key not in cls.model_fields:
                    comma = "" if isinstance(key, str) else " A decimal comma? Write a point."
                    known = suggest(str(key), cls.model_fields)
                    raise ValueError(f"unknown key '{key}'.{comma} {known}")
        return given


@dataclass(frozen=True)
class Rule:
    """A condition on a number, and on the value and limits of a parameter in its place."""

    holds: Callable[[float], bool]
    text: str


POSITIVE = Rule(lambda x: x > 0.0, "must be above 0")
NOT_NEGATIVE = Rule(lambda x: x >= 0.0, "must not be negative")
WARM = Rule(
    lambda x: x >= 150.0, "must be at least 150: temperatures are in K, and 20 °C is 293.15"
)
THIN = Rule(lambda x: x <= 0.5, "must be at most 0.5: thicknesses are in m, and 5 mm are 0.005")
FRACTION = Rule(lambda x: 0.0 <= x <= 1.0, "must lie within 0 and 1")
ANY = Rule(math.isfinite, "must be finite")


def _number(given: Any) -> Any:
    if isinstance(given, bool) or not isinstance(given, int | float | str):
        shown = "an empty value" if given is None else repr(given)
        raise ValueError(f"{shown} is neither a number nor the name of a parameter")
    if isinstance(given, str):
        if not given.isidentifier() and not _is_arithmetic(given):
            raise ValueError(f"'{given}' is neither a number nor the name of a parameter")
        return given
    return float(given)


def _is_arithmetic(text: str) -> bool:
    """Tell whether a text is an expression of parameters."""
    try:
        return bool(names_of(text))
    except ValueError:
        return False


Number = Annotated[float | str, BeforeValidator(_number), ANY]
"""A number, the name of a parameter, or an expression of parameters in SI units."""
AboveZero = Annotated[float, Field(gt=0.0)]
"""A number above zero, which no parameter may stand for."""
Positive = Annotated[Number, POSITIVE]
NotNegative = Annotated[Number, NOT_NEGATIVE]
Fraction = Annotated[Number, FRACTION]
Temperature = Annotated[Number, POSITIVE, WARM]
Thickness = Annotated[Number, POSITIVE, THIN]


def value_of(number: float | str, values: Mapping[str, Made]) -> float | Made:
    """Return a number itself, or the value of the parameter or the expression it names.

    >>> value_of("0.5 * c", {"c": 2000.0})
    1000.0
    """
    if not isinstance(number, str):
        return number
    return values[number] if number.isidentifier() else _evaluated(number, values)


def _evaluated(expression: str, values: Mapping[str, Any]) -> Any:
    """Return the value of an expression; for values of several sets, that of each set.

    Each set is computed by itself: the functions of numpy differ in last bits.
    """
    names = sorted(names_of(expression))
    shapes = np.broadcast_shapes(*(np.shape(values[name]) for name in names))
    if not shapes:
        return value_of_expression(expression, {name: float(values[name]) for name in names})
    columns = np.broadcast_arrays(*(values[name] for name in names))
    rows = (dict(zip(names, map(float, row), strict=True)) for row in zip(*columns, strict=True))
    return np.array([value_of_expression(expression, row) for row in rows])


def named_by(number: object) -> set[str]:
    """Return the names of the parameters on which a number depends.

    >>> named_by("a"), sorted(named_by("a / (1 - b)")), named_by(1.5)
    ({'a'}, ['a', 'b'], set())
    """
    if not isinstance(number, str):
        return set()
    return {number} if number.isidentifier() else names_of(number)


def replaced(part: Made, change: Callable[[str], float | str]) -> Made:
    """Return a description in which every name of a parameter in the place of a number is changed.

    Mass fractions of compositions are such numbers, too.
    """
    if not isinstance(part, Part):
        return part
    new = {}
    for name, field in type(part).model_fields.items():
        is_number = name in ("composition", "beside") or any(
            isinstance(m, Rule) for m in field.metadata
        )
        old = getattr(part, name)
        made = _replaced(old, is_number, change)
        if made is not old:
            new[name] = made
    return cast(Made, part.model_copy(update=new)) if new else part


def _replaced(value: Any, is_number: bool, change: Callable[[str], float | str]) -> Any:
    if isinstance(value, Part):
        return replaced(value, change)
    if isinstance(value, str):
        return change(value) if is_number else value
    if isinstance(value, Mapping):
        made = {k: _replaced(v, is_number, change) for k, v in value.items()}
        return made if any(made[k] is not v for k, v in value.items()) else value
    if isinstance(value, tuple):
        items = tuple(_replaced(v, is_number, change) for v in value)
        return items if any(a is not b for a, b in zip(items, value, strict=True)) else value
    return value


def numbers(
    part: object, path: str = "", of_place: tuple[Rule, ...] = ()
) -> Iterator[tuple[str, float | str, tuple[Rule, ...]]]:
    """Yield place, number or parameter name, and rules of every `Number` of a description.

    ``of_place`` are the rules of the place at which the part itself stands.
    """
    if isinstance(part, Part):
        for name, field in type(part).model_fields.items():
            place = f"{path}.{name}" if path else name
            value = getattr(part, name)
            rules = tuple(m for m in field.metadata if isinstance(m, Rule))
            if name in part.INHERITS:
                rules += of_place
            for where, leaf in _leaves(value, place):
                if isinstance(leaf, Part):
                    yield from numbers(leaf, where, rules)
                elif rules and isinstance(leaf, float | str):
                    yield where, leaf, rules
    elif isinstance(part, Mapping):
        for key, value in part.items():
            yield from numbers(value, f"{path}.{key}" if path else str(key))


def _leaves(value: object, place: str) -> Iterator[tuple[str, object]]:
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _leaves(item, f"{place}.{key}")
    elif isinstance(value, tuple):
        for i, item in enumerate(value):
            yield from _leaves(item, f"{place}.{i}")
    else:
        yield place, value
