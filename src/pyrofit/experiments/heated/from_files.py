"""What files of heated samples tell."""

import numpy as np
import pandas as pd

from pyrofit.experiments.from_files import Frames, FromFiles, Loss, NamedNumber

RATE_K_MIN = NamedNumber("K", (0.5, 500.0), 10.0)
AGREES = 0.1
"""Share by which a named heating rate may differ from the recorded one."""


def from_files(help: str, computed: tuple[float, ...] = (), signal: str = "") -> FromFiles:
    """Return what a new study needs of a kind of heated sample."""
    return FromFiles(
        help, RATE_K_MIN, recorded_rate, lambda frames: {}, mass_loss, computed, signal
    )


def recorded_rate(named: float, frames: Frames) -> float | None:
    """Return the heating rate [K/min]: the named one where the record agrees within 10 %.

    Where the temperature does not rise, as in a record of several ramps, there is none.
    """
    for frame in frames.values():
        rise = np.gradient(frame["temperature_K"].to_numpy(), frame["time_s"].to_numpy())
        rate = 60.0 * float(np.median(rise))
        if rate <= 0.0:
            return None
        return named if abs(rate - named) <= AGREES * abs(named) else float(f"{rate:.3g}")
    return None


def mass_loss(frames: Frames) -> Loss | None:
    """Return the temperature [K] of half the loss of mass, and the residue [kg/kg]."""
    frame: pd.DataFrame | None = frames.get("mass_fraction")
    if frame is None:
        return None
    mass, temperature = frame["mass_fraction"].to_numpy(), frame["temperature_K"].to_numpy()
    rest = float(np.median(mass[-5:]))
    below = np.flatnonzero(mass < 0.5 * (mass[0] + rest))
    if not below.size or rest >= 0.98:
        return None
    return Loss(float(temperature[below[0]]), rest)
