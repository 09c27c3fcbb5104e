"""Running means and minima."""

import numpy as np
import pandas as pd

from pyrofit.solver.arrays import FloatArray


def smoothed(series: pd.Series) -> pd.Series:
    """Return the mean over windows of 3 % of the points, an odd number, shorter at the ends."""
    window = 2 * (int(0.03 * len(series)) // 2) + 1
    return series.rolling(window, center=True, min_periods=1).mean()


def minima_on_one_axis(frame: pd.DataFrame, abscissa: str) -> tuple[FloatArray, FloatArray]:
    """Return the steps of all repetitions' running minima on one axis.

    Parameters
    ----------
    frame
        ``imp/convergence.csv`` of one cost.
    abscissa
        'generation' or 'calls'.

    Returns
    -------
    tuple of ndarray
        Abscissae, shape (m,), from where the last repetition finished its first generation; lowest
        cost so far, shape (repetitions, m). A repetition that ended keeps its last value.
    """
    runs = [
        (r[abscissa].to_numpy(float), r["best_cost"].to_numpy(float))
        for _, r in frame.sort_values("generation", kind="stable").groupby("repetition")
    ]
    start = max(x[0] for x, _ in runs)
    grid = np.unique(np.concatenate([x for x, _ in runs]))
    grid = grid[grid >= start]
    found = [cost[np.searchsorted(x, grid, side="right") - 1] for x, cost in runs]
    return grid, np.array(found)
