"""Values that an expression or a parameter can have within its limits, and their rules."""

import itertools
import math
from collections.abc import Iterator
from typing import Any

from pyrofit.config.keys.study import Study
from pyrofit.errors import suggest
from pyrofit.model.base import named_by, value_of
from pyrofit.model.parameters import Parameter

_MOST_NAMES = 8
"""Parameters of an expression of which all ends of their limits are tried."""


def ends_of(study: Study, number: float | str) -> list[float]:
    """Return the values in SI units that a number can have at its ends.

    Of a parameter these are its value and its limits; of an expression, its values at all
    combinations of the ends of its parameters. NaN stands for no value.
    """
    return [value for _, value in _ends(study, number)]


def _ends(study: Study, number: float | str) -> Iterator[tuple[dict[str, float], float]]:
    """Yield the values of the parameters, in SI units, and that of the number."""
    names = sorted(named_by(number))
    choices = [_of_parameter(study.parameters[name]) for name in names]
    if len(names) > _MOST_NAMES:
        choices = [ends[:1] for ends in choices]
    for ends in itertools.product(*choices):
        values = dict(zip(names, ends, strict=True))
        yield values, value_of(number, values)


def _of_parameter(p: Parameter) -> list[float]:
    return [x * p.factor for x in (p.value, p.lower, p.upper) if x is not None]


def check_expression(study: Study, expression: str, rules: Any, place: str) -> None:
    """Check an expression that stands for a number: its names and its values at the ends.

    Raises
    ------
    ValueError
        A parameter is unknown, or a value breaks a rule of the place.
    """
    for name in sorted(named_by(expression)):
        if name not in study.parameters:
            known = suggest(name, study.parameters)
            raise ValueError(f"{place}: unknown parameter '{name}'. {known}")
    truth = study.synthetic.truth if study.synthetic is not None else {}
    cases = list(_ends(study, expression))
    if named_by(expression) <= {*truth, *study.fixed_values()}:
        values = study.true_values()
        cases.append(({n: values[n] for n in named_by(expression)}, value_of(expression, values)))
    for values, value in cases:
        at = ", ".join(f"{n} = {v / study.parameters[n].factor:g}" for n, v in values.items())
        at = at or "these numbers"
        if math.isnan(value):
            raise ValueError(
                f"{place}: '{expression}' has no value with {at}, as after a division by zero; "
                "change the expression or the limits"
            )
        for rule in rules:
            if not rule.holds(value):
                raise ValueError(
                    f"{place}: {value:g} {rule.text}; this is '{expression}' in SI units with "
                    f"{at}. Change the expression or the limits"
                )
