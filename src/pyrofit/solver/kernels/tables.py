"""Properties that follow the temperature by a table."""

from typing import NamedTuple

from pyrofit.compiled.jit import inner
from pyrofit.solver.arrays import TABLE_SIZE, TABLE_START_K, TABLE_STEP_K, Number
from pyrofit.solver.kernels.functions import at_node, fma, whole

TABLE_END_K = TABLE_START_K + TABLE_STEP_K * (TABLE_SIZE - 1)


class Place(NamedTuple):
    """A temperature in the tables."""

    node: Number
    """The node below it."""
    part: Number
    """Of the distance from there to the next node."""


@inner
def place_of(T):
    """Return the place of a temperature."""
    x = (min(max(TABLE_START_K, T), TABLE_END_K) - TABLE_START_K) * (1.0 / TABLE_STEP_K)
    node = min(whole(x), TABLE_SIZE - 2.0)
    return Place(node, x - node)


@inner
def at_place(table, i, place, constant):
    """Return property i there, linear between the table's nodes; one node = constant."""
    if constant or table.shape[1] == 1:
        return table[i, 0] + 0.0 * place.part
    low = at_node(table, i, place.node)
    return fma(place.part, at_node(table, i, place.node + 1.0) - low, low)


@inner
def at_temperature(table, i, T):
    """Return property i at T."""
    return at_place(table, i, place_of(T), False)
