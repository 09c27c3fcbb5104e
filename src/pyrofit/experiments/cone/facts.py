"""Facts that files of a cone calorimeter contain."""

from typing import Any

import numpy as np

from pyrofit.experiments.from_files import Frames
from pyrofit.experiments.slab.from_files import start
from pyrofit.quantities.mass import ENDS, mass_released

BURNS = 0.1
"""Share of the largest heat release rate from which the sample is taken to burn."""
LOST = 0.01
"""Share of the lost mass from which it is taken to burn, without a rate. In 131 records of the
MaCFP data base that have both, the two times differ by 0 s (median), and by 9 s without sign."""


def facts(frames: Frames) -> dict[str, Any]:
    """Return the facts of a slab's record, the time of ignition [s], and what tells it.

    Without heat release rate and mass there is none.
    """
    ignition, told = None, None
    if (frame := frames.get("heat_release_rate")) is not None:
        rate = frame["heat_release_rate_W_m2"]
        ignition = float(frame["time_s"][rate >= BURNS * rate.max()].iloc[0])
        told = f"{100.0 * BURNS:g} % of the largest heat release rate"
    elif (frame := frames.get("mass")) is not None and len(frame) > ENDS:
        time, mass = frame["time_s"].to_numpy(), frame["mass_kg_m2"].to_numpy()
        least = np.median(mass[:ENDS]) - LOST * mass_released(time, mass)
        # Without a loss of mass no record ignites.
        medians = np.median(np.lib.stride_tricks.sliding_window_view(mass, ENDS), axis=1)
        lower = np.flatnonzero(medians < least)
        if lower.size and mass_released(time, mass) > 0.0:
            ignition = float(time[lower[0] + ENDS // 2])
            told = f"{100.0 * LOST:g} % of the lost mass"
    return start(frames) | {"ignition_s": ignition, "ignition_told": told}
