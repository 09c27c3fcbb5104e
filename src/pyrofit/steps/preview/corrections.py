"""Errors of a description or a file, each as the correction that would undo it."""

from collections.abc import Callable, Collection, Iterator, Sequence
from typing import Any

import numpy as np

from pyrofit.data.heating import usual_rise
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.slab import SlabExperiment
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.steps.preview.changes import (
    column_changed,
    heated_at,
    multiplied,
    part_changed,
    shifted,
)
from pyrofit.steps.preview.corrections_of_several import baselines, places, swaps, weights
from pyrofit.steps.preview.likely_cause import (
    CLOCK,
    FLUX,
    RATE,
    SAMPLE,
    SURROUNDINGS,
    TEMPERATURE,
    THICKNESS,
    ZERO,
    LikelyCause,
)
from pyrofit.steps.preview.reach import Channel, RecordedCases

TENS = (10.0, 0.1)
FACTORS = (10.0, 0.1, 100.0, 0.01, 1e3, 1e-3, 60.0, 1.0 / 60.0, 4.0, 0.25, 2.0, 0.5)
"""Factors of values: units, minutes for seconds, radius for diameter."""
MINUTES = (60.0, 1.0 / 60.0)
SHIFTS_S = (-300.0, -120.0, -60.0, -30.0, 30.0, 60.0, 120.0, 300.0)
FLAT = 0.1
"""Change of a record before the start of a test at most, over its range: without a flux nothing
happens. A shift that leaves the test itself out would explain everything."""
BELOW_ZERO = -0.02
"""Last mass of a sample over its first one, below which the zero of the balance is off."""
ROOM_K = 293.15
ROOM_RANGE_K = (283.0, 323.0)
"""Temperatures at which records usually start."""
AGREES = 0.1
"""Share by which the rise of the recorded temperatures may differ from the heating rate."""
USUAL_K = (250.0, 450.0)
"""Temperatures of gas and walls that need no explanation."""


def possible_corrections(
    case: RecordedCases, outside: Sequence[Channel], mostly: Collection[Channel]
) -> Iterator[LikelyCause]:
    """Yield the corrections that may bring records inside: of each experiment, then of several.

    Parameters
    ----------
    case
        Experiments and records.
    outside
        Experiment and signal of the records outside.
    mostly
        Records that a factor of ten or more may take outside: other records are not tried with it.
    """
    names = list(dict.fromkeys(name for name, _ in outside))
    for name in names:
        of = [signal for experiment, signal in outside if experiment == name]
        yield from _of_one(case, name, of, mostly)
    yield from weights(case, names)
    yield from baselines(case, outside)
    yield from places(case, outside)
    yield from swaps(case, names)


def _of_one(
    case: RecordedCases, name: str, outside: Sequence[str], mostly: Collection[Channel]
) -> Iterator[LikelyCause]:
    experiment = case.experiments[name]
    yield from _temperatures(case, name, outside)
    if isinstance(experiment, SlabExperiment):
        yield from _powers_of_ten(name)
        yield from _surroundings(experiment, name)
    yield from _clocks(case, name)
    if isinstance(experiment, HeatedExperiment):
        yield from _rates(case, name)
        yield from _zeros(case, name)
    yield from _samples(case, name, outside, mostly)


def _temperatures(case: RecordedCases, name: str, outside: Sequence[str]) -> Iterator[LikelyCause]:
    for signal in outside:
        quantity = case.experiments[name].quantity(signal)
        column = quantity.column if quantity.is_temperature else "temperature_K"
        if column not in case.frames[name, signal]:
            continue
        first = float(case.frames[name, signal][column].iloc[0])
        for words, unit in _UNITS.items():
            if _is_of_a_room(first) and not _is_of_a_room(unit(first)):
                continue  # as it is read, the record starts in a room
            yield LikelyCause(
                TEMPERATURE,
                (name,),
                f"the {quantity.title} of {name}: the temperatures are {words}",
                column_changed(name, (signal,), column, unit),
            )


def _is_of_a_room(kelvin: float) -> bool:
    return ROOM_RANGE_K[0] <= kelvin <= ROOM_RANGE_K[1]


_UNITS: dict[str, Callable[[Any], Any]] = {
    "in K, and were read as °C": lambda T: T - ICE_POINT_K,
    "in °C, and were read as K": lambda T: T + ICE_POINT_K,
    "in °F, and were read as °C": lambda T: (T - ICE_POINT_K - 32.0) / 1.8 + ICE_POINT_K,
}


def _powers_of_ten(name: str) -> Iterator[LikelyCause]:
    for kind, what, place in ((FLUX, "flux", "front"), (THICKNESS, "thickness", "sample")):
        for factor in TENS:
            yield LikelyCause(
                kind,
                (name,),
                f"the {what} of {name} is {_off(factor)}",
                part_changed(name, place, f"{what}_factor", factor),
            )


def _surroundings(experiment: SlabExperiment, name: str) -> Iterator[LikelyCause]:
    for place in ("front", "back"):
        side = getattr(experiment, place)
        for key in ("gas_temperature_K", "wall_temperature_K"):
            given = getattr(side, key, None)
            if isinstance(given, float) and not USUAL_K[0] <= given <= USUAL_K[1]:
                yield LikelyCause(
                    SURROUNDINGS,
                    (name,),
                    f"{place}.{key} of {name} is {given:g} K, not that of a room",
                    part_changed(name, place, key, None, ROOM_K),
                )


def _clocks(case: RecordedCases, name: str) -> Iterator[LikelyCause]:
    signals = case.signals(name)
    if isinstance(case.experiments[name], HeatedExperiment):
        return
    for factor in MINUTES:
        given, read = ("minutes", "seconds") if factor > 1.0 else ("seconds", "minutes")
        yield LikelyCause(
            CLOCK,
            (name,),
            f"the times of {name} are in {given}, and were read as {read}",
            column_changed(name, signals, "time_s", multiplied(factor)),
        )
    for shift in SHIFTS_S:
        if not all(_is_flat(case, (name, signal), -shift) for signal in signals):
            continue
        late = "early" if shift > 0.0 else "late"
        yield LikelyCause(
            CLOCK,
            (name,),
            f"the clock of {name} is about {abs(shift):g} s {late}",
            shifted(name, signals, shift),
        )


def _is_flat(case: RecordedCases, channel: Channel, until_s: float) -> bool:
    """Tell whether a record hardly changes up to a time, as before the start of a test."""
    name, signal = channel
    frame = case.frames[channel]
    values = frame[case.experiments[name].quantity(signal).column].to_numpy(float)
    early = values[frame["time_s"].to_numpy(float) < until_s]
    return early.size == 0 or float(np.ptp(early)) <= FLAT * float(np.ptp(values))


def _rates(case: RecordedCases, name: str) -> Iterator[LikelyCause]:
    experiment = case.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    given = experiment.heating_rate_K_min
    if _is_recorded(case, name, given):
        return
    heated = (e for e in case.experiments.values() if isinstance(e, HeatedExperiment))
    others = {e.heating_rate_K_min for e in heated}
    rates = dict.fromkeys([given * f for f in (*MINUTES, *TENS)] + sorted(others - {given}))
    for rate in rates:
        yield LikelyCause(
            RATE,
            (name,),
            f"the heating rate of {name} is {rate:.3g} K/min, not {given:g} K/min",
            heated_at(name, case.signals(name), rate, rate / given),
        )


def _is_recorded(case: RecordedCases, name: str, rate_K_min: float) -> bool:
    """Tell whether measured times and temperatures rise at the heating rate.

    Times that follow from the rate rise without any scatter, and prove nothing.
    """
    for signal in case.signals(name):
        frame = case.frames[name, signal]
        rises = np.diff(frame["temperature_K"]) / np.diff(frame["time_s"])
        scatters = float(np.ptp(rises)) > 1e-3 * abs(float(np.median(rises)))
        time, T = frame["time_s"].to_numpy(float), frame["temperature_K"].to_numpy(float)
        usual = 60.0 * usual_rise(time, T)
        if scatters and abs(usual - rate_K_min) <= AGREES * rate_K_min:
            return True
    return False


def _zeros(case: RecordedCases, name: str) -> Iterator[LikelyCause]:
    """Yield that a mass fraction ends below zero: then at zero, with the first value as it is."""
    for signal in case.signals(name):
        quantity = case.experiments[name].quantity(signal)
        values = case.frames[name, signal][quantity.column].to_numpy(float)
        first, last = float(values[0]), float(values[-1])
        if quantity.scales[0] == "fraction" and last < BELOW_ZERO * first:
            yield LikelyCause(
                ZERO,
                (name,),
                f"the zero of the balance of {name} is off: the {quantity.title} ends at "
                f"{last:.2f}",
                column_changed(name, (signal,), "", _from_zero),
            )


def _from_zero(mass: Any) -> Any:
    """Return a mass that ends at zero and begins as before."""
    return mass[0] * (mass - mass[-1]) / (mass[0] - mass[-1])


def _samples(
    case: RecordedCases, name: str, outside: Sequence[str], mostly: Collection[Channel]
) -> Iterator[LikelyCause]:
    experiment = case.experiments[name]
    for signal in outside:
        quantity = experiment.quantity(signal)
        if quantity.is_temperature or quantity.unit == "-":
            continue
        alike = [s for s in case.signals(name) if experiment.quantity(s).unit == quantity.unit]
        for factor in FACTORS:
            if not 0.1 < factor < 10.0 and (name, signal) not in mostly:
                continue
            yield LikelyCause(
                SAMPLE,
                (name,),
                f"the {quantity.title} of {name} is {_off(factor)}: area or mass "
                "of the sample, or the unit",
                column_changed(name, alike, "", multiplied(factor)),
            )


def _off(factor: float) -> str:
    """Say how far a given value is off, where ``factor`` corrects it.

    >>> _off(0.1), _off(60.0)
    ('10 times too large', '60 times too small')
    """
    return f"{1.0 / factor:g} times too large" if factor < 1.0 else f"{factor:g} times too small"
