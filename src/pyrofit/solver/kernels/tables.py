"""Properties that follow the temperature by a table."""

from pyrofit.solver.arrays import TABLE_SIZE, TABLE_START_K, TABLE_STEP_K
from pyrofit.solver.kernels.functions import at_node, fma, whole
from pyrofit.solver.kernels.jit import inner

TABLE_END_K = TABLE_START_K + TABLE_STEP_K * (TABLE_SIZE - 1)


@inner
def at_temperature(table, i, T):
    """Return property i at T, linear between the table's nodes; one node = constant."""
    if table.shape[1] == 1:
        return table[i, 0] + 0.0 * T
    x = (min(max(TABLE_START_K, T), TABLE_END_K) - TABLE_START_K) * (1.0 / TABLE_STEP_K)
    node = min(whole(x), TABLE_SIZE - 2.0)
    low = at_node(table, i, node)
    return fma(x - node, at_node(table, i, node + 1.0) - low, low)
