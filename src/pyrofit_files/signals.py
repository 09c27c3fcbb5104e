"""Signals of a file, found by the properties of their quantities."""

from collections.abc import Callable

from pyrofit.experiments import KINDS
from pyrofit.quantities import known_quantities
from pyrofit.quantities.base import Quantity
from pyrofit_files.examined import Examined, FileSignal

_POWER = "specific power"


def heated_mass(seen: Examined) -> FileSignal | None:
    """Return the mass of a heated sample in kg; None where there is none."""
    return _first(seen, lambda s, q: s.scale == "mass" and q.against_temperature)


def slab_mass(seen: Examined) -> FileSignal | None:
    """Return the mass of a slab in kg."""
    return _first(seen, lambda s, q: s.scale == "mass" and q.sampling == "cumulative")


def mass_signal(seen: Examined) -> FileSignal | None:
    """Return the mass of a heated sample, as a fraction or not."""
    return _first(seen, lambda s, q: q.scales[0] == "fraction" and q.against_temperature)


def heat_release(seen: Examined) -> FileSignal | None:
    """Return the heat release rate per area."""
    return _first(seen, lambda s, q: s.scale == "heat flux")


def specific_release(seen: Examined) -> FileSignal | None:
    """Return the heat release rate per mass."""
    return _first(seen, lambda s, q: s.scale == _POWER and not q.has_sign)


def heat_flow(seen: Examined) -> FileSignal | None:
    """Return the heat flow per mass, whose sign files differ in."""
    return _first(seen, lambda s, q: s.scale == _POWER and q.has_sign)


def temperatures(seen: Examined) -> list[FileSignal]:
    """Return temperatures that are signals, else that of a heated sample."""
    found = [s for s in seen.signals.values() if (q := _of(s)) is not None and q.is_temperature]
    for signal in seen.signals.values():
        if signal.temperature_K is not None:
            T = signal.temperature_K
            return [FileSignal("", "Temperature", "K", "temperature", signal.x, T)]
    return found


def is_back(signal: FileSignal) -> bool:
    """Tell whether a signal is taken for the temperature of the back face."""
    quantity = _of(signal)
    return quantity is not None and quantity.title.startswith("back")


def is_slab(seen: Examined) -> bool:
    """Tell whether a file is of a slab under radiant heat."""
    return seen.kind in KINDS and KINDS[seen.kind].stage == "imp"


def is_heated(seen: Examined) -> bool:
    """Tell whether a file is of a sample in a furnace."""
    return seen.kind in KINDS and KINDS[seen.kind].stage == "kinetics"


def in_time(seen: Examined) -> list[FileSignal]:
    """Return the signals that were recorded over time."""
    return list(seen.signals.values()) if is_slab(seen) or is_heated(seen) else []


def _first(seen: Examined, fits: Callable[[FileSignal, Quantity], bool]) -> FileSignal | None:
    for signal in seen.signals.values():
        quantity = _of(signal)
        if quantity is not None and signal.y.size > 3 and fits(signal, quantity):
            return signal
    return None


def _of(signal: FileSignal) -> Quantity | None:
    return known_quantities().get(signal.quantity)
