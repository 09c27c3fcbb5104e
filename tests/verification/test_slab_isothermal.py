"""Reactions in a slab that stays at one temperature, against closed forms.

The step control watches the temperature, so the steps grow to their longest, 10 s or k dt = 0.1 to
0.4; the errors here are the largest that Padé's form and the splitting of reactions leave.
"""

from typing import Any

import numpy as np
import pytest
from cases import Curve, run, slab_experiment

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model.material import Material
from pyrofit.simulate import Accuracy
from pyrofit.solver.curves import Request

T = 600.0
E = 1.5e5
DEPTH, RHO = 5e-3, 1200.0
TIME = np.linspace(0.0, 600.0, 121)


def slab(*reactions: dict[str, Any]) -> Material:
    component = {
        "density_kg_m3": RHO,
        "conductivity_W_mK": 0.2,
        "specific_heat_J_kgK": 1500.0,
    }
    return Material.model_validate(
        {
            "components": dict.fromkeys("ABC", component),
            "reactions": {str(j): reaction for j, reaction in enumerate(reactions)},
            "composition": {"A": 1.0},
        }
    )


def reaction(reactant: str, rate_1_s: float, **more: Any) -> dict[str, Any]:
    """A reaction that has the given k at 600 K, without heat."""
    reference = {"reference_temperature_K": T, "reference_rate_1_s": rate_1_s}
    return {"reactant": reactant, "E_J_mol": E} | reference | more


def remaining(material: Material, accuracy: Accuracy | None = None) -> Curve:
    """Mass over initial mass of a slab at 600 K among gas and walls of 600 K."""
    around = {"h_W_m2K": 10.0, "gas_temperature_K": T, "wall_temperature_K": T}
    experiment = slab_experiment(
        DEPTH, around, around | {"emissivity": 0.9}, initial_temperature_K=T
    )
    curves = run(experiment, material, {"mass": Request(TIME)}, accuracy, {})
    assert curves.mass_error <= 1e-12
    share: Curve = curves.signals["mass"] / (DEPTH * RHO)
    return share


def test_rate_of_the_reference_temperature_is_the_rate_of_arrhenius() -> None:
    outright = {"reactant": "A", "E_J_mol": E, "A_1_s": 0.01 * np.exp(E / (GAS_CONSTANT * T))}
    assert remaining(slab(outright)) == pytest.approx(
        remaining(slab(reaction("A", 0.01))), abs=1e-12
    )


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_first_order_reaction_decays_exponentially(nu: float) -> None:
    # Measured: 1.2e-5.
    exact = nu + (1.0 - nu) * np.exp(-0.01 * TIME)
    found = remaining(slab(reaction("A", 0.01, products={"C": nu})))
    assert np.abs(found - exact).max() <= 2e-5


@pytest.mark.parametrize(("order", "limit"), [(0.5, 4e-4), (1.5, 1e-5), (2.0, 1e-5)])
def test_reaction_of_order_n_follows_the_closed_form(order: float, limit: float) -> None:
    # Measured: 2.5e-4, 5.0e-6, 2.8e-6.
    base = np.maximum(1.0 - (1.0 - order) * 0.01 * TIME, 0.0)
    found = remaining(slab(reaction("A", 0.01, order=order)))
    assert np.abs(found - base ** (1.0 / (1.0 - order))).max() <= limit


def test_consecutive_reactions_follow_bateman() -> None:
    # A -> 0.7 B -> 0.7 x 0.2 C with 0.02 and 0.01 per second.
    # Measured: 3.9e-4, with steps of 2.5 s 2.8e-5.
    a = np.exp(-0.02 * TIME)
    b = 0.7 * 0.02 * (a - np.exp(-0.01 * TIME)) / (0.01 - 0.02)
    c = 0.2 * (0.7 * (1.0 - a) - b)
    first = reaction("A", 0.02, products={"B": 0.7})
    second = reaction("B", 0.01, products={"C": 0.2})
    material, exact = slab(first, second), a + b + c
    assert np.abs(remaining(material) - exact).max() <= 6e-4
    assert np.abs(remaining(material, Accuracy(longest_step_s=2.5)) - exact).max() <= 4e-5


def test_intermediate_may_react_with_another_order() -> None:
    # A -> 0.5 B at once, then B with order 2: u = 1/(1 + k t). Measured: 2.3e-5.
    first = reaction("A", 1e3, products={"B": 0.5})
    found = remaining(slab(first, reaction("B", 0.01, order=2.0)))
    exact = 0.5 / (1.0 + 0.01 * TIME)
    assert np.abs(found - exact)[1:].max() <= 4e-5


def test_competing_reactions_share_the_reactant_by_their_rates() -> None:
    # A -> C with 0.01, A -> gas with 0.03 per second: a quarter becomes C.
    # Measured: 2.8e-4.
    exact = 0.25 + 0.75 * np.exp(-0.04 * TIME)
    found = remaining(slab(reaction("A", 0.01, products={"C": 1.0}), reaction("A", 0.03)))
    assert np.abs(found - exact).max() <= 5e-4
