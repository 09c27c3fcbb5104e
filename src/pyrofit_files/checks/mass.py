"""Masses: unit, level, course, and the mass of the sample from elsewhere."""

import numpy as np

from pyrofit.data.suspect_mass import JUMP, standing_out
from pyrofit_files.examined import Examined, FileSignal
from pyrofit_files.signals import heated_mass, is_heated, slab_mass

_MICRO_KG = (5e-7, 1e-4)
"""Masses of samples in a crucible [kg]."""
_SLAB_KG = (2e-3, 1.0)
_RISE = 0.02
"""Share of the initial mass by which a sample may seem to grow."""
_NEGATIVE = -0.01
_README = 0.02
"""Deviation of the first mass from that of the README which is unusual."""
_DENSITY = (50.0, 3000.0)
"""Densities of polymers and woods, with room [kg/m3]."""


def _mass_of(seen: Examined) -> FileSignal | None:
    return heated_mass(seen) or slab_mass(seen)


def check_mass_unit(seen: Examined) -> None:
    """Look for fractions under the unit of a mass, and for masses of the wrong order."""
    signal = _mass_of(seen)
    if signal is None:
        return
    first, written = float(signal.y[0]), signal.unit
    if "fraction" in signal.header.casefold():
        text = f"a mass fraction by its name, a mass in '{written}' by its unit and numbers"
        seen.say("mass unit", "fault", text, signal.header)
    low, high = _MICRO_KG if is_heated(seen) else _SLAB_KG
    given = first / {"mg": 1e-6, "g": 1e-3, "kg": 1.0}.get(written, 1.0)
    if abs(given - 100.0) < 1.0 and is_heated(seen):
        seen.say("mass unit", "fault", f"begins at 100 {written}: percent?", signal.header)
    elif not low < first < high:
        text = f"begins at {given:.4g} {written}, unusual for such a sample"
        seen.say("mass unit", "fault", text, signal.header)


def check_course(seen: Examined) -> None:
    """Look for a mass that grows, jumps, falls below zero, or was not tared."""
    signal = _mass_of(seen)
    if signal is None:
        return
    if signal.y[0] <= 0.0:
        text = "begins at 0 or below: a change of mass, or tared with the sample?"
        seen.say("mass level", "fault", text, signal.header)
        return
    m = signal.y / signal.y[0]
    end, largest = float(np.median(m[-5:])), float(m.max())
    if end > 1.0 + _RISE:
        text = f"grows to {end:.3g} times its first value: is the sign of the loss wrong?"
        seen.say("mass sign", "fault", text, signal.header)
        return
    at = int(m.argmax())
    spikes = standing_out(m, JUMP)[:1000]
    if spikes.size:
        row = int(spikes[np.argmax(np.abs(m[spikes] - 1.0))])
        text = f"{spikes.size} values jump and come back, as {m[row]:.3g} m0 at {signal.x[row]:g} s"
        seen.say("mass jump", "fault", text, signal.header)
    elif largest > 1.0 + _RISE:
        text = f"rises to {largest:.3g} m0 at {signal.x[at]:g} s before it falls"
        seen.say("mass level", "doubt", text, signal.header)
    lowest = float(m.min())
    if lowest < _NEGATIVE:
        at = int(m.argmin())
        text = f"falls to {lowest:.3g} m0 at {signal.x[at]:g} s: the level of zero is off"
        seen.say("mass level", "doubt", text, signal.header)


def check_readme(seen: Examined) -> None:
    """Compare the first mass with that of the README."""
    signal, known = _mass_of(seen), seen.facts.mass_kg
    if signal is None or known is None:
        return
    off = float(signal.y[0]) / known - 1.0
    if abs(off) > _README:
        unit = {"mg": 1e6, "g": 1e3}.get(signal.unit, 1.0)
        text = (
            f"begins at {signal.y[0] * unit:.5g} {signal.unit}, the README says "
            f"{known * unit:.5g} ({100.0 * off:+.3g} %)"
        )
        seen.say("mass against README", "doubt", text, signal.header)


def check_density(seen: Examined) -> None:
    """Compare the mass with thickness and area of the README."""
    signal, facts = slab_mass(seen), seen.facts
    if signal is None or not facts.area_m2 or not facts.thickness_m:
        return
    density = float(signal.y[0]) / (facts.area_m2 * facts.thickness_m)
    if not _DENSITY[0] < density < _DENSITY[1]:
        text = (
            f"mass over area ({facts.area_m2:g} m2) and thickness ({facts.thickness_m * 1e3:g} mm) "
            f"of the README is {density:.4g} kg/m3"
        )
        seen.say("density", "fault", text, signal.header)
