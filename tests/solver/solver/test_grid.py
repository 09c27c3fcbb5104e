"""How many cells a slab is given."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from pyrofit.config import Study, as_study
from pyrofit.experiments import Gasification
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.base import value_of
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_gasification
from pyrofit.solver import lower, lower_experiment, lower_exposure, lower_network
from pyrofit.solver.arrays import IntArray, Values
from pyrofit.solver.curves import Request
from pyrofit.solver.kernels.grid import LEAST_CELLS, MANY_CELLS, MOST_CELLS, cells_needed

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"
VALUES = {
    "T_p": 605.0,
    "E_p": 190e3,
    "rho": 1190.0,
    "k": 0.2,
    "cp": 2100.0,
    "eps": 0.9,
    "dh": 8e5,
}


def study(**changes: Any) -> Study:
    given = yaml.safe_load(SMOKE.read_text(encoding="utf-8"))
    given["material"]["components"]["residue"].update(changes)
    return as_study(given, "smoke.yaml")


def cells(
    thickness_m: float = 0.02, chosen: Study | None = None, nu: float = 0.01, **values: float
) -> int:
    """Return the cells of a thick slab under 60 kW/m2."""
    chosen = chosen or study()
    material = chosen.material
    reaction = material.reactions["pyrolysis"].model_copy(update={"products": {"residue": nu}})
    material = material.model_copy(update={"reactions": {"pyrolysis": reaction}})
    experiment = chosen.experiments["slab_60"]
    layer = experiment.sample.layers[0].model_copy(update={"thickness_m": thickness_m})
    sample = experiment.sample.model_copy(update={"layers": (layer,)})
    experiment = experiment.model_copy(update={"sample": sample})
    assert isinstance(experiment, Gasification)
    (found,) = of_sets(experiment, material, VALUES | values, 1)
    return int(found)


def of_sets(experiment: Gasification, material: Material, values: Values, sets: int) -> IntArray:
    arrays = lower.lower_material(material, values, sets)
    layers = lower_experiment.lower_layers(experiment, material, arrays, values, sets)
    share = lower_experiment.lower_share(experiment, material, values, sets)
    return cells_needed(
        share,
        np.asarray(sum(layer.thickness for layer in layers)),
        np.full(sets, value_of(experiment.sample.initial_temperature_K, values)),
        arrays,
        lower_network.lower_network(material, values, sets),
        lower_exposure.lower_exposure(experiment, share, arrays, values, sets),
    )


def test_cells_grow_with_the_thickness() -> None:
    # And their number with its eighth root.
    assert cells(0.02) > MANY_CELLS
    assert cells(0.04) == pytest.approx(2**1.125 * cells(0.02), rel=5e-3)


def test_cells_are_inverse_to_the_conductivity() -> None:
    # Not quite: the surface is hotter where less heat is led away, and radiates more.
    assert 1.8**1.125 < cells(k=0.1) / cells(k=0.2) < 2.0**1.125


def test_a_reaction_of_higher_activation_energy_needs_more_cells() -> None:
    assert cells(E_p=250e3) > 1.2 * cells(E_p=190e3)


def test_a_residue_that_absorbs_better_or_stays_needs_more_cells() -> None:
    bare = cells(eps=0.5)
    assert cells(chosen=study(emissivity=0.5), eps=0.5) < bare
    assert cells(nu=0.5) > 1.5 * cells()


def test_thin_and_thick_slabs_end_at_the_limits() -> None:
    assert cells(1e-4) == LEAST_CELLS
    assert cells(10.0) == MOST_CELLS


def test_a_slab_that_does_not_react_gets_the_fewest_cells() -> None:
    assert cells(nu=1.0) == LEAST_CELLS


def test_given_cells_or_a_factor_override_the_choice() -> None:
    chosen = study()
    experiment = chosen.experiments["slab_25"]
    assert isinstance(experiment, Gasification)
    request = {"mlr": Request(np.array([100.0]))}
    found = [
        simulate_gasification(experiment, chosen.material, VALUES, request, accuracy).cells
        for accuracy in (Accuracy(), Accuracy(cells=17), Accuracy(cells_factor=1.5))
    ]
    assert found == [50, 17, 75]
    assert Accuracy(cells=17).refined().cells == 34


def test_every_set_gets_its_own_cells() -> None:
    chosen = study()
    experiment = chosen.experiments["slab_60"]
    assert isinstance(experiment, Gasification)
    conductivity = np.array([0.02, 0.2, 0.05, 0.01])
    given = experiment, chosen.material
    at_once = of_sets(*given, VALUES | {"k": conductivity}, 4).tolist()
    assert at_once == [of_sets(*given, VALUES | {"k": k}, 1).item() for k in conductivity.tolist()]
    assert len(set(at_once)) == 4
