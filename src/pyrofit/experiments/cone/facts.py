"""Facts that files of a cone calorimeter contain."""

from typing import Any

from pyrofit.experiments.from_files import Frames
from pyrofit.experiments.slab.from_files import start

BURNS = 0.1
"""Share of the largest heat release rate from which the sample is taken to burn."""


def facts(frames: Frames) -> dict[str, Any]:
    """Return the facts of a slab's record and the time of ignition [s]; None without one."""
    ignition = None
    if (frame := frames.get("heat_release_rate")) is not None:
        rate = frame["heat_release_rate_W_m2"]
        ignition = float(frame["time_s"][rate >= BURNS * rate.max()].iloc[0])
    return start(frames) | {"ignition_s": ignition}
