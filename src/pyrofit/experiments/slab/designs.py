"""New tests of a slab: at other fluxes and thicknesses, or with the back insulated."""

from collections.abc import Callable, Iterator, Mapping

from pyrofit.effects.base import changed, has_open_back
from pyrofit.experiments.base import Idea
from pyrofit.model.slab import Layer, SlabExperiment

FLUXES_W_M2 = (15e3, 40e3, 60e3, 90e3)
"""Fluxes that are usual."""
FLUX_FACTORS = (0.5, 1.5)
"""Others, relative to those measured."""
SAME_FLUX = 0.2
"""Fluxes that differ relatively by less make the same test."""
THICKNESSES = {"half": 0.5, "double": 2.0}
INSULATED: dict[str, float] = {
    "h_W_m2K": 0.0,
    "h_change_W_m2K": 0.0,
    "h_cube_root_W_m2K43": 0.0,
    "emissivity": 0.0,
}
"""Keys of a back that loses no heat."""
RATE, LEVEL, BACK = "mlr", "mass", "back_temperature"
"""Quantities that a new test records: rate, or mass where no rate is, and the back temperature."""


def designs(
    own: Mapping[str, SlabExperiment],
    measured: Mapping[str, SlabExperiment],
    recorded: Mapping[str, set[str]],
) -> Iterator[Idea]:
    """Yield new tests, and the measured ones with the back temperature where that is missing."""
    masses = [quantities for quantities in recorded.values() if LEVEL in quantities]
    loss = LEVEL if masses and not any(RATE in q for q in recorded.values()) else RATE
    yield from _other_fluxes(own, measured, loss)
    for name, slab in own.items():
        if BACK not in recorded[name]:
            yield Idea(name, lambda e: e, (_with_back(name, f"{_words(name, slab)} again", loss),))
        known = all(isinstance(layer.thickness_m, float) for layer in slab.sample.layers)
        for word, factor in THICKNESSES.items() if known else ():
            words = f"{_words(name, slab)}, {word} the thickness"
            yield Idea(name, _thicker(factor), _choices(f"{name}_{word}_thickness", words, loss))
        if has_open_back(slab):
            words = f"{_words(name, slab)}, the back insulated"
            yield Idea(name, _insulated, _choices(f"{name}_insulated_back", words, loss))


def _words(name: str, slab: SlabExperiment) -> str:
    flux = slab.front.flux_W_m2
    return f"{slab.APPARATUS} at {flux / 1e3:g} kW/m²" if isinstance(flux, float) else f"'{name}'"


def _choices(design: str, words: str, loss: str) -> tuple[tuple[str, str, tuple[str, ...]], ...]:
    return (design, words, (loss,)), _with_back(design, words, loss)


def _with_back(design: str, words: str, loss: str) -> tuple[str, str, tuple[str, ...]]:
    return f"{design}+{BACK}", f"{words}, with the back temperature", (loss, BACK)


def _other_fluxes(
    slabs: Mapping[str, SlabExperiment], others: Mapping[str, SlabExperiment], loss: str
) -> Iterator[Idea]:
    """Yield tests at fluxes that were not measured, each like the one at the nearest flux."""
    measured, taken = _fluxes(slabs), list(_fluxes(others).values())
    wanted = FLUXES_W_M2 + tuple(f * q for q in measured.values() for f in FLUX_FACTORS)
    for q in wanted if measured else ():
        if any(abs(q - other) < SAME_FLUX * other for other in taken):
            continue
        taken.append(q)
        like = min(measured, key=lambda name: abs(measured[name] - q))
        words = f"{slabs[like].APPARATUS} at {q / 1e3:g} kW/m²"
        choices = _choices(f"flux_{q / 1e3:g}_kW_m2", words, loss)
        yield Idea(like, _at_flux(q), choices)


def _fluxes(slabs: Mapping[str, SlabExperiment]) -> dict[str, float]:
    found = {name: slab.front.flux_W_m2 for name, slab in slabs.items()}
    return {name: q for name, q in found.items() if isinstance(q, float)}


def _at_flux(flux: float) -> Callable[[SlabExperiment], SlabExperiment]:
    return lambda slab: changed(slab, front=changed(slab.front, flux_W_m2=flux))


def _thicker(factor: float) -> Callable[[SlabExperiment], SlabExperiment]:
    def change(slab: SlabExperiment) -> SlabExperiment:
        layers = tuple(_scaled(layer, factor) for layer in slab.sample.layers)
        return changed(slab, sample=changed(slab.sample, layers=layers))

    return change


def _scaled(layer: Layer, factor: float) -> Layer:
    assert isinstance(layer.thickness_m, float)
    return changed(layer, thickness_m=factor * layer.thickness_m)


def _insulated(slab: SlabExperiment) -> SlabExperiment:
    return changed(slab, back=changed(slab.back, **INSULATED))
