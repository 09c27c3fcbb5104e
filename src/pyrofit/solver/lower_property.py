"""From properties in words to tables over temperature, for all sets at once."""

import math
from collections.abc import Callable, Iterable, Sequence
from functools import reduce
from typing import Any

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.properties import Changed, Linear, PowerLaw, Table
from pyrofit.numerics import functions
from pyrofit.solver.arrays import (
    TABLE_TEMPERATURES_K,
    FloatArray,
    Value,
    Values,
)

LEAST_SHARE = 0.01
"""Least value of a linear property, relative to its reference value, and of a changed one."""
SHORT = 64
"""Rows of at most so many numbers are added up faster in one call."""
NODES_K: FloatArray = TABLE_TEMPERATURES_K[:, None]


def stack(rows: Sequence[Value], sets: int) -> FloatArray:
    """Return one row per value, shape (values, sets)."""
    if sets == 1 and {float}.issuperset(map(type, rows)):
        return np.array(rows)[:, None]
    out = np.empty((len(rows), sets))
    for row, value in zip(out, rows, strict=True):
        row[:] = value
    return out


class Numbers:
    """Numbers of a description; those that no parameter changes are put in only once."""

    def __init__(self, numbers: Iterable[float | str]) -> None:
        self._given: list[Any] = list(numbers)
        self._named = [(i, n) for i, n in enumerate(self._given) if isinstance(n, str)]
        self._lowered: dict[str, Any] | None = None

    def rows(self, values: Values, sets: int) -> FloatArray:
        """Return one row per number, shape (numbers, sets)."""
        rows = self._given.copy()
        for i, name in self._named:
            rows[i] = value_of(name, values)
        return stack(rows, sets)

    def lowered(
        self, values: Values, sets: int, lower: Callable[[FloatArray], dict[str, Any]]
    ) -> dict[str, Any]:
        """Return ``lower(rows)``; where no parameter changes a number, once for a set alone."""
        if self._named or sets > 1:
            return lower(self.rows(values, sets))
        if self._lowered is None:
            self._lowered = lower(self.rows(values, sets))
        return self._lowered


def property_table(prop: object, values: Values, sets: int = 1) -> FloatArray:
    """Return p at the nodes of `TABLE_TEMPERATURES_K`, shape (nodes, sets); constant: (1, sets)."""
    return property_at(prop, values, NODES_K, sets)


def property_at(prop: object, values: Values, T: FloatArray, sets: int = 1) -> FloatArray:
    """Return p at temperatures [K], shape (points, sets); constant: (1, sets).

    The temperatures have the shape (points, 1), or (points, sets). A linear property ends at 1 %
    of its reference value: it must not become negative.
    """
    if isinstance(prop, float | str):
        return stack([value_of(prop, values)], sets)
    shape = len(T), sets
    if isinstance(prop, Table):
        points = stack([value_of(v, values) for v in prop.value], sets)
        at = np.broadcast_to(T, shape).T
        columns = [np.interp(t, prop.temperature_K, p) for t, p in zip(at, points.T, strict=True)]
        return np.stack(columns, axis=1) * value_of(prop.factor, values)
    if isinstance(prop, Changed):
        return _changed(prop, values, T, sets)
    assert isinstance(prop, Linear | PowerLaw)
    value = value_of(prop.value, values)
    reference = value_of(prop.reference_temperature_K, values)
    if isinstance(prop, Linear):
        rise = value_of(prop.slope_1_K, values) * (T - reference)
        table = value * np.maximum(LEAST_SHARE, 1.0 + rise)
    else:
        # Not a power: of some exponents numpy makes a root or a square, which rounds otherwise.
        table = value * functions.exp(
            value_of(prop.exponent, values) * functions.log(T / reference)
        )
    return np.broadcast_to(table, shape)


def _changed(prop: Changed, values: Values, T: FloatArray, sets: int) -> FloatArray:
    """Return of(T) with its changes; nothing but of(T) where these are zero.

    A change that is zero in all sets is left out: adding zero gives the same bits.
    """
    at = {
        name: value_of(getattr(prop, name), values) for name in Changed.model_fields if name != "of"
    }
    of = property_at(prop.of, values, T, sets)
    scale, above, width = at["scale"], T - at["step_temperature_K"], at["step_width_K"]
    slope: Value = 1.0
    if _given(at["slope_1_K"]):
        slope = slope + scale * at["slope_1_K"] * (T - at["reference_temperature_K"])
    if _given(at["bend"]):
        slope = slope + scale * at["bend"] * width * functions.log_one_plus_exp(above / width)
    changed = of * slope
    if _given(at["step"]) or _given(at["thinning"]):
        # 1 / (1 + exp(-x)), which would overflow.
        passed = 0.5 + 0.5 * functions.tanh(0.5 * above / width)
        changed = changed + scale * at["step"] * passed
    if _given(at["peak_area"]):
        away = (T - at["peak_temperature_K"]) / at["peak_width_K"]
        height = scale * at["peak_area"] / (math.sqrt(2.0 * math.pi) * at["peak_width_K"])
        changed = changed + height * functions.exp(-0.5 * away * away)
    if _given(at["thinning"]):
        changed = changed / np.maximum(1.0 + scale * at["thinning"] * passed, LEAST_SHARE)
    return np.asarray(np.maximum(changed, LEAST_SHARE * of))


def _given(change: Value) -> bool:
    """Tell whether a change differs from zero in any set."""
    return bool(np.any(change)) if isinstance(change, np.ndarray) else change != 0.0


def total(rows: FloatArray) -> FloatArray:
    """Return the sum of the rows, one after the other: the same bits for any number of sets."""
    if rows.size <= SHORT * len(rows):
        return np.asarray(np.add.accumulate(rows)[-1])
    return np.asarray(reduce(np.add, rows))
