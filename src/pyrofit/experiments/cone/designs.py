"""New tests of a slab that burns: those of a slab, with the heat release rate recorded."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from pyrofit.effects.base import changed
from pyrofit.experiments.base import Idea
from pyrofit.experiments.slab import designs as of_slab

HEAT = "heat_release_rate"


def designs(
    own: Mapping[str, Any], measured: Mapping[str, Any], recorded: Mapping[str, set[str]]
) -> Iterator[Idea]:
    """Yield the new tests of a slab, with the heat release rate and a flame of their own times."""
    for idea in of_slab.designs(own, measured, recorded):
        choices = tuple((name, words, (HEAT, *of)) for name, words, of in idea.choices)
        yield replace(idea, change=_burning(idea.change), choices=choices)


def _burning(change: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def changed_too(cone: Any) -> Any:
        new = change(cone)
        return new if new == cone or cone.flame is None else changed(new, flame=_flame(cone, new))

    return changed_too


def _flame(cone: Any, new: Any) -> Any:
    """Return the flame of a changed test.

    It lasts to the end. Where ignition is described as a number, it comes earlier under a higher
    flux, t_ign ~ 1/q^2 as of a thick solid; where it is a parameter, that holds for the new test.
    """
    ignition, fluxes = cone.flame.ignition_s, (cone.front.flux_W_m2, new.front.flux_W_m2)
    # ASSUME: heat losses before ignition are small, and the sample is thermally thick.
    if isinstance(ignition, float) and all(isinstance(q, float) and q > 0.0 for q in fluxes):
        ignition *= (fluxes[0] / fluxes[1]) ** 2
    return changed(cone.flame, ignition_s=ignition, ends_s=None)
