"""Time to ignition of a record, by the usual definitions."""

from collections.abc import Iterable, Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pyrofit.experiments.cone.facts import BURNS
from pyrofit.model.slab import SlabExperiment
from pyrofit.quantities.base import Quantity
from pyrofit.steps.ignition.options import IgnitionOptions

FloatArray = NDArray[np.float64]

DEFINITIONS: Mapping[str, str] = {
    "described": "time that the study gives",
    "heat_release": "heat release rate above a threshold",
    "share_of_peak": f"heat release rate above {100.0 * BURNS:g} % of its largest value",
    "mass_loss": "mass loss rate above a threshold",
}
"""Meaning of each definition."""


def times_of(
    experiment: SlabExperiment,
    series: Iterable[tuple[Quantity, pd.DataFrame]],
    options: IgnitionOptions,
) -> dict[str, float | None]:
    """Return the time to ignition [s] by definition; None where a sample did not ignite.

    Parameters
    ----------
    experiment
        The test.
    series
        Its measured series, SI units.
    options
        Thresholds.
    """
    found: dict[str, float | None] = {}
    flame = experiment.burning()
    if flame is not None and isinstance(flame.ignition_s, float) and flame.ignition_s > 0.0:
        found["described"] = flame.ignition_s
    for quantity, frame in series:
        time, rate = (frame[c].to_numpy(float) for c in ("time_s", quantity.column))
        last = options.sustained_s
        if quantity.scales[0] == "heat flux":
            burns = first_above(time, rate, options.heat_release_W_m2, last)
            share = first_above(time, rate, BURNS * float(rate.max()), last)
            found |= {"heat_release": burns, "share_of_peak": None if burns is None else share}
        elif quantity.scales[0] == "mass flux":
            found["mass_loss"] = first_above(time, rate, options.mlr_kg_m2_s, last)
    return found


def first_above(
    time: FloatArray, rate: FloatArray, least: float, sustained_s: float
) -> float | None:
    """Return the time [s] from which a rate stays above a value; None where it never does.

    Between two points the rate is a straight line. A record that ends too early counts as one that
    stays above.

    Parameters
    ----------
    time, rate
        Times [s] and rates, shape (n,).
    least
        The value.
    sustained_s
        How long the rate must stay above [s].

    Examples
    --------
    >>> first_above(np.arange(5.0), np.array([0.0, 3.0, 0.0, 1.0, 4.0]), 2.0, 1.0)
    3.3333333333333335
    >>> first_above(np.arange(5.0), np.array([0.0, 3.0, 0.0, 1.0, 4.0]), 2.0, 0.0)
    0.6666666666666666
    """
    above = rate >= least
    for i in np.flatnonzero(above & ~np.append(False, above[:-1])):
        if above[(time >= time[i]) & (time <= time[i] + sustained_s)].all():
            if i == 0:
                return float(time[0])
            share = (least - rate[i - 1]) / (rate[i] - rate[i - 1])
            return float(time[i - 1] + share * (time[i] - time[i - 1]))
    return None
