"""Another heat capacity at the back of the sample."""

import numpy as np

from pyrofit.diagnose.corrections.correction import (
    Correction,
    Shape,
    Values,
    coefficient_names,
    derived,
    slabs_of,
)
from pyrofit.estimate.problem import Problem
from pyrofit.model.base import value_of
from pyrofit.model.slab import Foil

FOIL_SD = 500.0
"""Prior standard deviation of the foil's heat capacity per area [J/(m2 K)]: some 0.15 mm of copper,
or 3 % of 6 mm of a polymer."""


def foil_capacity(problem: Problem, T: tuple[float, float]) -> Correction:
    """Make C = C_0 + c, the heat capacity of the foil per area, at least zero."""
    (name,) = coefficient_names("foil_heat_capacity", 1)
    foils = {n: slab.sample.foil for n, slab in slabs_of(problem).items() if slab.sample.foil}
    own = {n: f"probe_foil_{i}_factor" for i, n in enumerate(foils)}

    def derive(values: Values) -> dict[str, float]:
        return {
            own[n]: max(
                value_of(foil.mass_factor, values) + values[name] / _capacity(foil, values), 0.0
            )
            for n, foil in foils.items()
        }

    def shape(values: Values) -> Shape:
        return [(at, values[name]) for at in T]

    return Correction(
        probe="foil_heat_capacity",
        what="another heat capacity at the back of the sample",
        unit="J/(m2 K)",
        sd={name: FOIL_SD},
        problem=derived(
            problem, {n: {"sample": {"foil": {"mass_factor": own[n]}}} for n in foils}, derive
        ),
        shape=shape,
    )


def _capacity(foil: Foil, values: Values) -> float:
    """Return the described heat capacity of a foil per area [J/(m2 K)]."""
    parts = (foil.density_kg_m3, foil.specific_heat_J_kgK, foil.thickness_m)
    return float(np.prod([value_of(part, values) for part in parts]))
