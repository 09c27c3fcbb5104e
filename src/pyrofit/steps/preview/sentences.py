"""What the preview found, in sentences."""

from collections.abc import Iterator

from pyrofit.config import Study
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.results.files import Results
from pyrofit.show.text import listed, several
from pyrofit.show.water import lacking_water
from pyrofit.steps.preview import record
from pyrofit.steps.preview.record import Preview, Window

LEAST_LEFT = 0.06
"""Difference from the nearest set, over the range, from which on a record is named."""


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on the data beside all that the limits allow."""
    return list(sentences_on(study, record.read(results)))


def sentences_on(study: Study, found: Preview) -> Iterator[str]:
    """Yield the sentences on what was found."""
    yield from _unfinished(found)
    if not found.nearest:
        yield "Data against limits: pyrofit itself simulates no record; nothing is compared."
        return
    yield from (_window(study, window) for window in found.windows)
    if not found.windows and found.far:
        yield from _far(study, found)
    if found.windows or found.far:
        yield from _causes(found)
        yield from _repeats(study, found)
    else:
        yield _reached(study, found)
    if (lacking := lacking_water(found)) != "":
        yield lacking
    if found.unmoved:
        verb = "moves" if len(found.unmoved) == 1 else "each move"
        yield (
            f"Between its limits {listed(found.unmoved)} {verb} no signal beyond its noise, and "
            "cannot be estimated from these data."
        )


def _reached(study: Study, found: Preview) -> str:
    sets = f"those of {found.sets} sets that finish" if found.unfinished else f"{found.sets} sets"
    records = several(len(found.nearest), "record")
    if any(experiment.repeat for experiment in study.experiments.values()):
        records += ", one repeat of each test, and the other repeats"
    return f"Data against limits: {sets} reach the data of all tests ({records})."


def _unfinished(found: Preview) -> Iterator[str]:
    for name, count in found.unfinished.items():
        left_out = "; its data are not compared" if count == found.sets else ""
        yield f"{name}: {count} of {found.sets} sets within the limits do not finish{left_out}."


def _window(study: Study, window: Window) -> str:
    experiment = study.experiments[window.experiment]
    quantity = experiment.quantity(window.signal)
    side = "above" if window.above else "below"
    span = window_span(quantity, window.begins, window.ends)
    word = "from" if " to " in span else "at"
    return (
        f"{window.experiment}, {experiment.words(window.signal)}: the data lie {side} all sets "
        f"{word} {span}, by up to "
        f"{size_words(quantity, window.largest)} ({100.0 * window.share:.0f} % of the range)."
    )


def window_span(quantity: Quantity, begins: float, ends: float) -> str:
    """Return a window in words: times, or temperatures of a heated sample; or one point."""
    unit, offset = ("°C", ICE_POINT_K) if quantity.against_temperature else ("s", 0.0)
    first, last = f"{begins - offset:.0f}", f"{ends - offset:.0f}"
    return f"{first} {unit}" if first == last else f"{first} to {last} {unit}"


def size_words(quantity: Quantity, value: float) -> str:
    """Return a difference of a quantity with its unit."""
    shown = quantity.shown
    unit = "K" if quantity.is_temperature else shown.unit.replace("–", "")
    return f"{shown.factor * value:.3g} {unit}".rstrip()


def _far(study: Study, found: Preview) -> Iterator[str]:
    worst = sorted(found.nearest, key=lambda one: -one.left)
    parts = [
        f"{one.experiment}, {study.experiments[one.experiment].words(one.signal)} "
        f"({100.0 * one.left:.0f} %)"
        for one in worst[:4]
        if one.left > LEAST_LEFT
    ]
    yield (
        "Each record alone lies within the limits and a margin for noise and model errors, but no "
        "set tried comes near all at once. The nearest one differs, in per cent of the "
        f"range, from {listed(parts)}."
    )


def _causes(found: Preview) -> Iterator[str]:
    if not found.causes:
        yield (
            "No single error that was tried explains this. Limits of several parameters may be "
            "too narrow, or the model may lack an effect, which the target `diagnosis` looks for."
        )
        return
    for i, one in enumerate(found.causes, 1):
        yield (
            f"Likely cause {i}: {one.words}. With that corrected, data and nearest set differ by "
            f"{100.0 * one.left:.1f} % of the range (rms)."
        )


def _repeats(study: Study, found: Preview) -> Iterator[str]:
    """Say which repeats lie outside beside the one that a cause names."""
    outside = dict.fromkeys(window.experiment for window in found.windows)
    named = dict.fromkeys(place for one in found.causes for place in one.places)
    for name in (name for name in named if name in study.experiments):
        test = study.experiments[name].repeat
        others = [
            other
            for other in outside
            if other != name
            and test is not None
            and (repeat := study.experiments[other].repeat) is not None
            and repeat.test == test.test
        ]
        if others:
            words = f"repeats of {name} that lie outside, too"
            yield f"The same may hold for {listed(others)}: {words}."
