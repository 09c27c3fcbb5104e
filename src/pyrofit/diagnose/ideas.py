"""New tests that may be made on the same apparatus, derived from those that were calibrated."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from pyrofit.effects.base import changed, has_open_back
from pyrofit.estimate.problem import Problem
from pyrofit.model.experiment import Gasification, Layer, Tga

FLUXES_W_M2 = (15e3, 40e3, 60e3, 90e3)
"""Fluxes that are usual."""
FLUX_FACTORS = (0.5, 1.5)
"""Others, relative to those measured."""
SAME_FLUX = 0.2
"""Fluxes that differ relatively by less make the same test."""
THICKNESSES = {"half": 0.5, "double": 2.0}
RATE_FACTOR = 3.0
"""How much slower and faster than all measured ones a new TGA is."""
INSULATED: dict[str, float] = {
    "h_W_m2K": 0.0,
    "h_change_W_m2K": 0.0,
    "h_cube_root_W_m2K43": 0.0,
    "emissivity": 0.0,
}
"""What a back that loses no heat has."""


@dataclass(frozen=True, eq=False)
class Idea:
    """A new test.

    Parameters
    ----------
    like
        The experiment it is derived from.
    change
        From the description of that experiment, effects included, to the new one.
    choices
        Short name, words and signals of each choice of what is recorded.
    """

    like: str
    change: Callable[[Any], Any]
    choices: tuple[tuple[str, str, tuple[str, ...]], ...]

    @property
    def most_signals(self) -> tuple[str, ...]:
        """Signals of the choice that has most."""
        return max((signals for _, _, signals in self.choices), key=len)


def ideas(problem: Problem, measured: Problem) -> Iterator[Idea]:
    """Yield new tests like those of a problem.

    At other fluxes, thicknesses and heating rates, with the back insulated, and the measured ones
    with the back temperature where that was not measured.

    Parameters
    ----------
    problem
        What was calibrated.
    measured
        That, and what was held out.
    """
    slabs, others = _slabs(problem), _slabs(measured)
    yield from _other_fluxes(slabs, others)
    for name, slab in slabs.items():
        if "back_temperature" not in measured.runs[name].requests:
            yield Idea(name, lambda e: e, (_with_back(name, f"{_words(name, slab)} again"),))
        known = all(isinstance(layer.thickness_m, float) for layer in slab.sample.layers)
        for word, factor in THICKNESSES.items() if known else ():
            words = f"{_words(name, slab)}, {word} the thickness"
            yield Idea(name, _thicker(factor), _choices(f"{name}_{word}_thickness", words))
        if has_open_back(slab):
            words = f"{_words(name, slab)}, the back insulated"
            yield Idea(name, _insulated, _choices(f"{name}_insulated_back", words))
    yield from _other_rates({n: r.experiment for n, r in problem.runs.items()})


def _slabs(problem: Problem) -> dict[str, Gasification]:
    found = {name: run.experiment for name, run in problem.runs.items()}
    return {name: e for name, e in found.items() if isinstance(e, Gasification)}


def _words(name: str, slab: Gasification) -> str:
    flux = slab.front.flux_W_m2
    return f"gasification at {flux / 1e3:g} kW/m²" if isinstance(flux, float) else f"'{name}'"


def _choices(design: str, words: str) -> tuple[tuple[str, str, tuple[str, ...]], ...]:
    return (design, words, ("mlr",)), _with_back(design, words)


def _with_back(design: str, words: str) -> tuple[str, str, tuple[str, ...]]:
    signals = ("mlr", "back_temperature")
    return f"{design}+back_temperature", f"{words}, with the back temperature", signals


def _other_fluxes(
    slabs: dict[str, Gasification], others: dict[str, Gasification]
) -> Iterator[Idea]:
    """Yield tests at fluxes that were not measured, each like the one at the nearest flux."""
    measured, taken = _fluxes(slabs), list(_fluxes(others).values())
    wanted = FLUXES_W_M2 + tuple(f * q for q in measured.values() for f in FLUX_FACTORS)
    for q in wanted if measured else ():
        if any(abs(q - other) < SAME_FLUX * other for other in taken):
            continue
        taken.append(q)
        like = min(measured, key=lambda name: abs(measured[name] - q))
        choices = _choices(f"flux_{q / 1e3:g}_kW_m2", f"gasification at {q / 1e3:g} kW/m²")
        yield Idea(like, _at_flux(q), choices)


def _fluxes(slabs: dict[str, Gasification]) -> dict[str, float]:
    found = {name: slab.front.flux_W_m2 for name, slab in slabs.items()}
    return {name: q for name, q in found.items() if isinstance(q, float)}


def _at_flux(flux: float) -> Callable[[Gasification], Gasification]:
    return lambda slab: changed(slab, front=changed(slab.front, flux_W_m2=flux))


def _thicker(factor: float) -> Callable[[Gasification], Gasification]:
    def change(slab: Gasification) -> Gasification:
        layers = tuple(_scaled(layer, factor) for layer in slab.sample.layers)
        return changed(slab, sample=changed(slab.sample, layers=layers))

    return change


def _scaled(layer: Layer, factor: float) -> Layer:
    assert isinstance(layer.thickness_m, float)
    return changed(layer, thickness_m=factor * layer.thickness_m)


def _insulated(slab: Gasification) -> Gasification:
    return changed(slab, back=changed(slab.back, **INSULATED))


def _other_rates(experiments: dict[str, Tga | Gasification]) -> Iterator[Idea]:
    """Yield a slower and a faster TGA than those measured."""
    rates = {n: e.heating_rate_K_min for n, e in experiments.items() if isinstance(e, Tga)}
    if not rates:
        return
    slowest, fastest = min(rates, key=lambda n: rates[n]), max(rates, key=lambda n: rates[n])
    for like, factor in ((slowest, 1.0 / RATE_FACTOR), (fastest, RATE_FACTOR)):
        rate = factor * rates[like]
        words = f"TGA at {rate:.3g} K/min"
        yield Idea(like, _at_rate(rate), ((f"tga_{rate:.3g}_K_min", words, ("mass_fraction",)),))


def _at_rate(rate: float) -> Callable[[Tga], Tga]:
    return lambda tga: changed(tga, heating_rate_K_min=rate)
