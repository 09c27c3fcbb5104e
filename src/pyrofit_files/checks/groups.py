"""Tests of one kind compared with each other: factors, signs and levels."""

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from pyrofit_files.examined import Examined, FileSignal, FloatArray
from pyrofit_files.signals import (
    heat_flow,
    heat_release,
    is_heated,
    is_slab,
    mass_signal,
    slab_mass,
    specific_release,
)

_FEWEST = 4
"""Tests that a comparison needs."""
_FACTOR = 1.6
_USUAL_AREA_M2 = 0.01
_HALF_K = 15.0
_SLAB = 1.35


def check_heat_per_mass(files: Sequence[Examined]) -> None:
    """Compare the heat released per lost mass with that of the other tests of the material."""
    _compare(files, _material, _heat_per_mass, "heat per mass", _FACTOR, "MJ/kg", 1e-6)


def check_scale(files: Sequence[Examined]) -> None:
    """Compare the size of heat flows and specific heat release with that of other tests."""
    for size in (_peak_area, _released):
        _compare(files, _by_test, size, "scale", 2.0, "kJ/kg", 1e-3)


def check_initial_mass(files: Sequence[Examined]) -> None:
    """Compare the initial mass per area of slabs with that of the other tests of the material."""
    _compare(files, _by_slab, _mass_per_area, "initial mass", _SLAB, "kg/m2", 1.0)


def check_half_loss(files: Sequence[Examined]) -> None:
    """Compare the temperature at half the loss of mass with that of other laboratories."""
    for group in _groups(files, _by_test):
        found = [(seen, T) for seen in group if (T := _half_loss(seen)) is not None]
        if len(found) < _FEWEST:
            continue
        usual = float(np.median([T for _, T in found]))
        for seen, T in found:
            if abs(T - usual) > _HALF_K:
                text = (
                    f"half the mass is lost at {T:.0f} K, {T - usual:+.0f} K from the median of "
                    f"{len(found)} such tests"
                )
                seen.say("temperature offset", "doubt", text)


def check_sign(files: Sequence[Examined]) -> None:
    """Compare the sign of the heat flow where the mass is lost with that of other tests."""
    for group in _groups(files, _by_test):
        found = [(seen, peak) for seen in group if (peak := _peak(seen)) is not None]
        up = sum(peak > 0.0 for _, peak in found)
        if len(found) < _FEWEST:
            continue
        for seen, peak in found:
            if (peak > 0.0) != (2 * up >= len(found)):
                text = f"its largest peak points {'up' if peak > 0 else 'down'}, unlike most others"
                seen.say("heat sign", "doubt", text)


def _groups(
    files: Sequence[Examined], key: Callable[[Examined], object]
) -> Iterator[list[Examined]]:
    groups: dict[object, list[Examined]] = defaultdict(list)
    for seen in files:
        if (own := key(seen)) is not None and "TEMPLATE" not in str(seen.path):
            groups[own].append(seen)
    yield from groups.values()


def _compare(
    files: Sequence[Examined],
    key: Callable[[Examined], object],
    number: Callable[[Examined], float | None],
    check: str,
    factor: float,
    unit: str,
    shown: float,
) -> None:
    """Doubt numbers that differ from the median of their group by more than a factor."""
    for group in _groups(files, key):
        found = [(s, x) for s in group if (x := number(s)) is not None and x > 0.0]
        if len(found) < _FEWEST:
            continue
        usual = float(np.median([x for _, x in found]))
        for seen, x in found:
            if not 1.0 / factor < x / usual < factor:
                text = (
                    f"{x * shown:.3g} {unit}, {x / usual:.2g} times the median of {len(found)} "
                    "such tests: a factor, a unit or a level?"
                )
                seen.say(check, "doubt", text)


def _material(seen: Examined) -> str:
    """Return the material: the folder above `Calibration_Data`, and that in the file's name."""
    parts = seen.path.parts
    above = parts[parts.index("Calibration_Data") - 1] if "Calibration_Data" in parts else ""
    return f"{above}/{seen.label.material}"


def _by_slab(seen: Examined) -> object:
    """Return material and thickness; none of a small sample whose area is not known."""
    small = seen.label.word.casefold() == "capa"
    if not is_slab(seen) or (small and not seen.facts.area_m2):
        return None
    thickness = seen.facts.thickness_m
    return _material(seen), small and thickness and round(thickness, 3)


def _by_test(seen: Examined) -> object:
    cycled = seen.label.word.casefold().startswith("tm") or any(
        f.check == "heating rate" and f.weight == "doubt" for f in seen.findings
    )
    return None if cycled or not is_heated(seen) else (_material(seen), *seen.label.group[2:])


def _heat_per_mass(seen: Examined) -> float | None:
    heat, mass = heat_release(seen), slab_mass(seen)
    if heat is None or mass is None:
        return None
    lost = float(np.median(mass.y[:5]) - np.median(mass.y[-5:]))
    if lost <= 0.0:
        return None
    area = seen.facts.area_m2 or _USUAL_AREA_M2
    return float(np.trapezoid(heat.y, heat.x)) * area / lost


def _mass_per_area(seen: Examined) -> float | None:
    mass = slab_mass(seen)
    if mass is None:
        return None
    return float(mass.y[0]) / (seen.facts.area_m2 or _USUAL_AREA_M2)


def _half_loss(seen: Examined) -> float | None:
    signal = mass_signal(seen)
    if signal is None or signal.temperature_K is None:
        return None
    level = signal.y[0] - 0.5 * (signal.y[0] - signal.y[-1])
    below = np.flatnonzero(signal.y <= level)
    return float(signal.temperature_K[below[0]]) if below.size and below[0] > 0 else None


def _released(seen: Examined) -> float | None:
    """Return all heat released per mass."""
    heat = specific_release(seen)
    return None if heat is None else float(np.trapezoid(np.maximum(heat.y, 0.0), heat.x))


def _peak_area(seen: Examined) -> float | None:
    """Return the area of a peak of the heat flow above the line between its feet."""
    flow = heat_flow(seen)
    if flow is None or not _has_peak(seen):
        return None
    above = _above_line(flow)
    return None if above is None else abs(float(np.trapezoid(above[1], above[0])))


def _has_peak(seen: Examined) -> bool:
    """Tell whether a heat flow has one large peak: not in air, and not of wood."""
    return seen.label.inert and not _material(seen).startswith("Wood")


def _peak(seen: Examined) -> float | None:
    flow = heat_flow(seen)
    if flow is None or not _has_peak(seen):
        return None
    above = _above_line(flow)
    return None if above is None else float(above[1][np.argmax(np.abs(above[1]))])


def _above_line(flow: FileSignal) -> tuple[FloatArray, FloatArray] | None:
    """Return times and heights of a heat flow above the line between 560 K and 720 K."""
    T = flow.temperature_K
    if T is None:
        return None
    inside = (T > 560.0) & (T < 720.0)
    if inside.sum() < 8:
        return None
    t, y = flow.x[inside], flow.y[inside]
    return t, y - np.interp(t, t[[0, -1]], y[[0, -1]])
