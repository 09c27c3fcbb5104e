"""New tests of a sample that follows a temperature programme: slower and faster."""

from collections.abc import Callable, Collection, Iterator, Mapping

from pyrofit.effects.base import changed
from pyrofit.experiments.base import Idea
from pyrofit.model.heated import HeatedExperiment
from pyrofit.quantities import quantities_of

RATE_FACTOR = 3.0
"""How much slower and faster than all measured ones a new test is."""


def designs(
    kind: str,
    words: str,
    own: Mapping[str, HeatedExperiment],
    recorded: Mapping[str, Collection[str]],
) -> Iterator[Idea]:
    """Yield a slower and a faster test than those measured, which record the same."""
    rates = {name: e.heating_rate_K_min for name, e in own.items() if not e.is_isothermal}
    if not rates:
        return
    slowest, fastest = min(rates, key=lambda n: rates[n]), max(rates, key=lambda n: rates[n])
    for like, factor in ((slowest, 1.0 / RATE_FACTOR), (fastest, RATE_FACTOR)):
        rate = factor * rates[like]
        quantities = tuple(q for q in quantities_of(kind) if q in recorded[like])
        choice = f"{kind}_{rate:.3g}_K_min", f"{words} at {rate:.3g} K/min", quantities
        yield Idea(like, _at_rate(rate), (choice,))


def _at_rate(rate: float) -> Callable[[HeatedExperiment], HeatedExperiment]:
    return lambda heated: changed(heated, heating_rate_K_min=rate)
