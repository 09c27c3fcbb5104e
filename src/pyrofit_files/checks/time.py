"""Times: increasing, from the start of the test on."""

import numpy as np

from pyrofit_files.examined import Examined
from pyrofit_files.signals import in_time

_GAP = 20.0
"""Multiple of the usual step that counts as a gap."""
_LATE_S = 60.0


def check_times(seen: Examined) -> None:
    """Look for times that do not increase, and for gaps and steps of different length."""
    for signal in in_time(seen)[:1]:
        step = np.diff(signal.x)
        if step.size < 3:
            continue
        if (stops := np.flatnonzero(step <= 0.0)).size:
            row = int(stops[0])
            text = (
                f"time does not increase in {stops.size} rows, first from {signal.x[row]:g} s to "
                f"{signal.x[row + 1]:g} s"
            )
            seen.say("time", "fault", text)
        usual = float(np.median(step))
        if usual > 0.0 and (gaps := np.flatnonzero(step > max(_GAP * usual, 30.0))).size:
            row = int(gaps[np.argmax(step[gaps])])
            text = (
                f"{gaps.size} gaps in time, the longest from {signal.x[row]:g} s to "
                f"{signal.x[row + 1]:g} s (usual step {usual:g} s)"
            )
            seen.say("time", "note" if row == 0 else "doubt", text)


def check_start(seen: Examined) -> None:
    """Look for times before 0, and for records that begin late."""
    for signal in in_time(seen)[:1]:
        start = float(signal.x[0])
        if start < 0.0:
            seen.say("time", "doubt", f"time begins at {start:g} s, before the start")
        elif start > _LATE_S:
            text = f"time begins at {start:g} s: earlier times, such as a hold, are cut off"
            seen.say("time", "note", text)
