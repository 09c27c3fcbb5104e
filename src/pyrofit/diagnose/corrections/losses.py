"""Another loss of a side over its temperature."""

import numpy as np

from pyrofit.diagnose.corrections.correction import (
    Correction,
    Shape,
    Values,
    coefficient_names,
    derived,
    slabs_of,
)
from pyrofit.diagnose.corrections.flux_tables import named_numbers, table_of
from pyrofit.effects.base import changed, has_open_back
from pyrofit.estimate.problem import Problem
from pyrofit.model.base import value_of
from pyrofit.model.slab_faces import Back, Side
from pyrofit.model.time_table import at_start
from pyrofit.numerics import functions
from pyrofit.solver.arrays import FloatArray

LOSS_SD = {"gas_temperature_K": 30.0, "h_change_W_m2K": 6.0, "h_cube_root_W_m2K43": 0.8}
"""Prior standard deviations for the loss of a side, SI units, by key of the description."""


def loss(problem: Problem, T: FloatArray, side: str) -> Correction:
    """Make q = (h_0 + c_1)(T_s - T_g) + (C_0 + c_2)(T_s - T_g)^(4/3), with T_g = T_gas + c_0.

    The correction is drawn at the temperatures T of the surface.
    """
    names = dict(zip(LOSS_SD, coefficient_names(f"{side}_heat_loss", len(LOSS_SD)), strict=True))
    slabs = {n: s for n, s in slabs_of(problem).items() if side == "front" or has_open_back(s)}
    described = {name: getattr(slab, side) for name, slab in slabs.items()}
    own = {
        name: {key: named_numbers(getattr(face, key), f"probe_{side}_{key}_{i}") for key in LOSS_SD}
        for i, (name, face) in enumerate(described.items())
    }

    def derive(values: Values) -> dict[str, float]:
        return {
            str(new): value_of(old, values) + values[coefficient]
            for name, face in described.items()
            for key, coefficient in names.items()
            for new, old in zip(
                table_of(own[name][key]).value, table_of(getattr(face, key)).value, strict=True
            )
        }

    def shape(values: Values) -> Shape:
        name, face = next(iter(described.items()))
        before = _convection(face, values, T)
        after = _convection(changed(face, **own[name]), {**values, **derive(values)}, T)
        return list(zip(T.tolist(), (after - before).tolist(), strict=True))

    return Correction(
        probe=f"{side}_heat_loss",
        what=f"another heat loss of the {side} over its temperature",
        unit="W/m2",
        sd=dict(zip(names.values(), LOSS_SD.values(), strict=True)),
        problem=derived(problem, {n: {side: o} for n, o in own.items()}, derive),
        shape=shape,
    )


def _convection(side: Side, values: Values, T: FloatArray) -> FloatArray:
    """Return the loss of a side by convection [W/m2], of tables at the start, the gas risen."""
    h = max(at_start(side.h_W_m2K, values) + value_of(side.h_change_W_m2K, values), 0.0)
    above = T - at_start(side.gas_temperature_K, values) - value_of(side.gas_rise_K, values)
    root = value_of(side.h_cube_root_W_m2K43, values) * functions.cube_root(np.abs(above))
    factor = value_of(side.loss_factor, values) if isinstance(side, Back) else 1.0
    return np.asarray(factor * (h + root) * above)
