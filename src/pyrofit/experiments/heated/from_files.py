"""Facts that files of heated samples contain."""

import numpy as np
import pandas as pd

from pyrofit.data.heating import usual_rise
from pyrofit.experiments.from_files import Frames, FromFiles, Loss, NamedNumber
from pyrofit.solver.arrays import FloatArray

_MINUTE = r"[ _]?(?:/|per[ _]?)?[ _]?min(?:ute)?(?:\^?[-−]1)?"
RATE_K_MIN = NamedNumber(
    rf"[KC](?:{_MINUTE}|pm)?|(?:(?:[°º]|deg(?:rees?)?[ _.]?)C|℃){_MINUTE}",
    (0.5, 500.0),
    10.0,
    "heating rate",
    "K/min",
    "beta|β|(?:heating[ _-]?)?rate",
)
HOLD_K = 5.0
"""Span of temperatures within which one is held."""
STILL = 0.02
"""Share of the loss of mass in the last tenth of a record from which on the end is no residue."""
CHAR = 0.1
"""Residue above which a solid chars."""
AHEAD = 4.0
"""Multiple of the loss in that last tenth that may still come. Char is left if more than `CHAR`
remains then. At a temperature that is held all of it may come."""
TAIL = 0.25
"""Largest loss in that last tenth, over that in the tenth that loses most, of char whose reaction
is over. A record that ends before tells no char."""
LEVEL = 0.01
"""Share of the loss of mass above the end up to which a record counts as level."""
DRY_K, REACTS_K = 420.0, 470.0
"""Temperature up to which a loss is moisture; half of the loss of a dried sample comes later."""
PARTS = 0.125, 0.5, 0.875
"""Shares of the loss of a dried sample at which parallel reactions are looked for."""
AGREES = 0.1
"""Share by which a named heating rate may differ from the recorded one."""


def from_files(help: str, computed: tuple[float, ...] = (), signal: str = "") -> FromFiles:
    """Return the entries of a new study for a kind of heated sample."""
    return FromFiles(help, RATE_K_MIN, recorded_rate, held, mass_loss, computed, signal)


def held(frames: Frames) -> dict[str, float | None]:
    """Return the temperature [K] that a record holds over its second half; None where it does not.

    >>> t = np.linspace(0.0, 100.0, 101)
    >>> T = np.minimum(300.0 + 10.0 * t, 600.0)
    >>> held({"mass_fraction": pd.DataFrame({"time_s": t, "temperature_K": T})})
    {'set_point_K': 600.0}
    """
    for frame in frames.values():
        time, temperature = frame["time_s"].to_numpy(), frame["temperature_K"].to_numpy()
        late = temperature[time > 0.5 * (time[0] + time[-1])]
        if late.size > 2 and np.ptp(late) < HOLD_K:
            return {"set_point_K": float(f"{np.median(late):.4g}")}
        return {"set_point_K": None}
    return {"set_point_K": None}


def recorded_rate(named: float, frames: Frames) -> float | None:
    """Return the heating rate [K/min]: the named one where the record agrees within 10 %.

    Where the temperature does not rise, as in a record of several ramps, there is none. Nor is
    there one where it is held from the start: its drift is no heating rate.
    """
    for frame in frames.values():
        heating = _heating(frame, held(frames)["set_point_K"])
        if heating is None:
            return None
        rate = 60.0 * usual_rise(heating["time_s"].to_numpy(), heating["temperature_K"].to_numpy())
        if rate <= 0.0:
            return None
        return named if abs(rate - named) <= AGREES * abs(named) else float(f"{rate:.3g}")
    return None


def _heating(frame: pd.DataFrame, set_point_K: float | None) -> pd.DataFrame | None:
    """Return the part of a record before a hold; None where there is not enough of it."""
    if set_point_K is None:
        return frame
    before = int(np.argmax(frame["temperature_K"].to_numpy() > set_point_K - HOLD_K))
    return None if before < 3 else frame.iloc[:before]


def _rest(mass: FloatArray) -> float:
    """Return the mass at the end: the mean of the second half of the level part, 5 points at least.

    A mean of few points would differ from the level by their noise, which a fit shows as misfit.
    """
    rest = float(np.median(mass[-max(mass.size // 10, 5) :]))
    falling = np.flatnonzero(mass > rest + LEVEL * (mass[0] - rest))
    level = mass.size - 1 - int(falling[-1]) if falling.size else mass.size
    return float(np.mean(mass[-max(level // 2, 5) :]))


def mass_loss(frames: Frames) -> Loss | None:
    """Return the temperature [K] of half the loss of mass, the residue [kg/kg], and its parts."""
    frame: pd.DataFrame | None = frames.get("mass_fraction")
    if frame is None:
        return None
    mass, temperature = frame["mass_fraction"].to_numpy(), frame["temperature_K"].to_numpy()
    rest = _rest(mass)
    below = np.flatnonzero(mass < 0.5 * (mass[0] + rest))
    if not below.size or rest >= 0.98 or mass[0] <= 0.0:
        return None
    end = float(np.median(mass[-5:]))
    lost_late = mass[9 * mass.size // 10] - end
    is_held = held({"mass_fraction": frame})["set_point_K"] is not None
    # Char that still loses some mass.
    slow = rest - AHEAD * lost_late >= CHAR and not is_held and lost_late < TAIL * _steepest(mass)
    goes_on = lost_late > STILL * (mass[0] - rest) and not slow
    half = float(temperature[below[0]])
    dried = int(np.argmax(temperature >= DRY_K)) if half > REACTS_K else 0
    dry = float(np.median(mass[max(dried - 2, 0) : dried + 3])) if dried else float(mass[0])
    parts = tuple(
        float(temperature[np.argmax(mass < dry - share * (dry - rest))]) for share in PARTS
    )
    moisture = max(1.0 - dry / float(mass[0]), 0.0)
    record = frame["time_s"].to_numpy(), temperature, mass
    known = None if goes_on else rest
    return Loss(half, known, moisture, (parts[0], parts[1], parts[2]), record, is_held, end)


def _steepest(mass: FloatArray) -> float:
    """Return the largest loss of mass over a tenth of a record."""
    tenth = max(mass.size // 10, 1)
    return float(np.max(mass[:-tenth] - mass[tenth:]))
