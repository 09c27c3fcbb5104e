"""Layers that hold components beside the material."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from bases import Base, having, run, wood
from pydantic import ValidationError

from pyrofit.effects.base import changed
from pyrofit.model.material import REST
from pyrofit.model.slab import Layer, SlabExperiment

MOIST = {"beside": {"ash": "w"}}
"""Ash lets the shares be seen in the density alone."""


def layered(base: Base, **layer: Any) -> Base:
    """Return a base whose slabs have other layers of the same thickness."""
    experiments = dict(base.experiments)
    for name, slab in base.experiments.items():
        if isinstance(slab, SlabExperiment):
            layers = [changed(own, **layer) for own in slab.sample.layers]
            experiments[name] = changed(slab, sample=changed(slab.sample, layers=tuple(layers)))
    return replace(base, experiments=experiments, values=base.values | {"w": 0.08})


def test_layer_is_the_material_and_what_stands_beside_it() -> None:
    beside = run(layered(wood(), **MOIST), "flux_60")[1]
    composed = run(layered(wood(), composition={"wood": REST, "ash": "w"}), "flux_60")[1]
    for own, other in zip(beside, composed, strict=True):
        assert np.array_equal(own, other)
    dry = run(wood(), "flux_60")[1]
    assert np.max(np.abs(beside[0] - dry[0])) > 1e-4


def test_shares_of_the_material_keep_their_proportions() -> None:
    layer = Layer(thickness_m=0.01, beside={"water": 0.1, "glue": "g"})
    composed = layer.composed({"early": "w_e", "main": REST})
    assert composed == {"early": "(w_e) * (1 - 0.1 - g)", "main": REST, "water": 0.1, "glue": "g"}
    assert layer.composed({"early": 0.2, "main": 0.8})["early"] == REST


@pytest.mark.parametrize("effect", ["volatile", "second_component"])
def test_effect_of_the_material_changes_such_a_layer(effect: str) -> None:
    base = layered(wood(), **MOIST)
    none, some = (run(having(base, {effect: {"share": x}}), "flux_60")[1] for x in (0.0, 0.1))
    assert np.max(np.abs(some[0] - none[0])) > 1e-4
    own = layered(wood(), composition={"wood": REST, "ash": "w"})
    with pytest.raises(ValueError, match="no experiment can have it"):
        having(
            replace(own, experiments={"flux_60": own.experiments["flux_60"]}),
            {effect: {"share": 0.1}},
        )


def test_a_composition_of_its_own_or_parts_beside_the_material() -> None:
    with pytest.raises(ValidationError, match="not both"):
        Layer(thickness_m=0.01, composition={"copper": 1.0}, beside={"water": 0.1})
    with pytest.raises(ValidationError, match="the rest is the material"):
        Layer(thickness_m=0.01, beside={"water": REST})
