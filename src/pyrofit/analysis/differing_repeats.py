"""Repeats of a test that disagree, in words."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.estimate.repeats_agree import Difference, differences, is_held, tolerance_of
from pyrofit.model.experiment import Experiment
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import ICE_POINT_K

TEMPERATURE = "temperature_K"
DESCRIBED_PERCENT = 2.0
"""Difference of the described masses of two samples that explains different records."""


def differing_repeats(quantity: Quantity, frames: Sequence[pd.DataFrame]) -> list[Difference]:
    """Return the series of one quantity that differ from the others, in SI units."""
    heated = quantity.against_temperature
    if heated and not all(TEMPERATURE in frame for frame in frames):
        return []
    held = are_held(quantity, frames)
    key = TEMPERATURE if heated and not held else "time_s"
    rising = [_rising(frame, key, quantity.column) for frame in frames]
    at, values = zip(*rising, strict=True)
    return differences(at, values, tolerance_of(quantity, held))


def are_held(quantity: Quantity, frames: Iterable[pd.DataFrame]) -> bool:
    """Tell whether the temperature of some of these samples is held while they react."""
    return quantity.against_temperature and any(
        is_held(*(frame[key].to_numpy(np.float64) for key in (TEMPERATURE, quantity.column)))
        for frame in frames
    )


def _rising(frame: pd.DataFrame, key: str, column: str) -> tuple[np.ndarray, np.ndarray]:
    """Return abscissa and values where the abscissa is above all before."""
    at = frame[key].to_numpy(np.float64)
    new = np.concatenate([[True], at[1:] > np.maximum.accumulate(at)[:-1]])
    return at[new], frame[column].to_numpy(np.float64)[new]


def notes_on_repeats(
    study: Study, frames: Mapping[tuple[str, str], pd.DataFrame]
) -> Iterator[tuple[tuple[str, str], str]]:
    """Yield (experiment, signal) and a note for each series that differs from its repeats."""
    groups: dict[tuple[str, str], list[str]] = {}
    for name, signal in frames:
        repeat = study.experiments[name].repeat
        if repeat is not None and not repeat.nuisances:
            groups.setdefault((repeat.test, signal), []).append(name)
    for (_, signal), names in groups.items():
        quantity = study.experiments[names[0]].quantity(signal)
        records = [frames[name, signal] for name in names]
        for d in differing_repeats(quantity, records):
            held = are_held(quantity, records)
            words = differs(d.kind, d.size, d.low, d.high, quantity, held)
            yield (names[d.position], signal), f"{words}. {_way_out(study, names, d.position)}"


def _way_out(study: Study, names: Sequence[str], position: int) -> str:
    """Say what to do with a record, or that its sample is described as a heavier or lighter one."""
    masses = [_relative_mass(study.experiments[name]) for name in names]
    others = float(np.mean(np.delete(masses, position)))
    percent = 100.0 * (masses[position] / others - 1.0)
    # A sample without a factor of its own is not described as another one.
    if masses[position] == 1.0 or abs(percent) < DESCRIBED_PERCENT:
        return WAY_OUT
    more = "more" if percent > 0.0 else "less"
    return f"Its sample weighs {abs(percent):.0f} % {more}, and the study describes it so"


def _relative_mass(experiment: Experiment) -> float:
    """Return the mass of a piece over that of the description; 1 where no number tells it."""
    sample = getattr(experiment, "sample", None)
    factors = [getattr(sample, key, 1.0) for key in ("density_factor", "thickness_factor")]
    return math.prod(factor for factor in factors if isinstance(factor, float))


DIFFERS = "differs from its repeats"
WAY_OUT = "Leave it out, or explain it"


def differs(
    kind: str, size: float, low: float, high: float, quantity: Quantity, held: bool = False
) -> str:
    """Say in what a record differs from its repeats, see `pyrofit.estimate.repeats_agree`."""
    heated = quantity.against_temperature and not held
    said = f"{DIFFERS}: the {quantity.title}"
    if kind == "start":
        unit, earlier, later = ("K", "lower", "higher") if heated else ("s", "earlier", "later")
        return f"{said} changes {abs(size):.0f} {unit} {later if size > 0.0 else earlier}"
    if kind == "level":
        more = "more" if size > 0.0 else "less"
        return f"{said} changes {100.0 * abs(size):.0f} % {more} in all"
    zero, unit = (ICE_POINT_K, "°C") if heated else (0.0, "s")
    return (
        f"{said} has another shape, by {100.0 * size:.0f} % of the range (rms), most from "
        f"{low - zero:.0f} to {high - zero:.0f} {unit}"
    )


def lines_on_repeats(
    quantity: Quantity, names: Iterable[str], frames: Sequence[pd.DataFrame]
) -> list[str]:
    """Return a line for each of some named series that differs from the others."""
    found, words = list(names), []
    for d in differing_repeats(quantity, frames):
        said = differs(d.kind, d.size, d.low, d.high, quantity, are_held(quantity, frames))
        words.append(f"{found[d.position]} {said}. {WAY_OUT}")
    return words
