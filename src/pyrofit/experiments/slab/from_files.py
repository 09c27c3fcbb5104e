"""Facts that files of slabs under radiant heat contain."""

from collections.abc import Callable
from typing import Any

from pyrofit.experiments.from_files import Frames, FromFiles, NamedNumber
from pyrofit.quantities import known_quantities

FLUX_KW_M2 = NamedNumber("[kK][wW](?:[ _-]?m[-^]?2)?", (5.0, 150.0), 50.0, "flux", "kW/m2", "q")
ROOM_K = 293.15


def start(frames: Frames) -> dict[str, Any]:
    """Return the temperature [K] at which a recorded temperature starts, else that of a room."""
    for name, frame in frames.items():
        quantity = known_quantities()[name]
        if quantity.is_temperature:
            return {"start_K": round(float(frame[quantity.column].iloc[0]), 1)}
    return {"start_K": ROOM_K}


def from_files(
    help: str,
    facts: Callable[[Frames], dict[str, Any]] = start,
    computed: tuple[float, ...] = (),
    signal: str = "",
) -> FromFiles:
    """Return the entries of a new study for a kind of slab."""
    return FromFiles(
        help, FLUX_KW_M2, lambda named, frames: None, facts, lambda frames: None, computed, signal
    )
