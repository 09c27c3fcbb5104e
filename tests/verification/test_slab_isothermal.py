"""Reactions in a slab that stays at one temperature

A slab at 600 K among gas and walls of 600 K, reactions without heat: the mass follows closed
forms in k t, with k of 0.01 and 0.02 1/s. The steps grow to their longest, 10 s or k dt = 0.1 to
0.4: the errors here are the largest that the Padé form of the exponential leaves.
"""

from typing import Any

import numpy as np
import pytest
from cases import Curve, run, slab_experiment
from evidence import MASS, TIME, Evidence, Line

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.solver.curves import Request

T = 600.0
E = 1.5e5
DEPTH, RHO = 5e-3, 1200.0
TIMES = np.linspace(0.0, 600.0, 121)


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
    share: Curve = signal(material, "mass", accuracy) / (DEPTH * RHO)
    return share


def signal(material: Material, name: str, accuracy: Accuracy | None = None) -> Curve:
    """A signal of that slab."""
    around = {"h_W_m2K": 10.0, "gas_temperature_K": T, "wall_temperature_K": T}
    experiment = slab_experiment(
        DEPTH, around, around | {"emissivity": 0.9}, initial_temperature_K=T
    )
    return run(experiment, material, {name: Request(TIMES)}, accuracy, {}).signals[name]


def state(
    evidence: Evidence, title: str, found: Curve, exact: Curve, tolerance: float, source: str
) -> None:
    line = Line(TIMES, found, exact)
    evidence.curve(f"isothermal slab: {title}", TIME, MASS, line, f"exact: {source}", tolerance)


def test_rate_of_the_reference_temperature_is_the_rate_of_arrhenius() -> None:
    outright = {"reactant": "A", "E_J_mol": E, "A_1_s": 0.01 * np.exp(E / (GAS_CONSTANT * T))}
    assert remaining(slab(outright)) == pytest.approx(
        remaining(slab(reaction("A", 0.01))), abs=1e-12
    )


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_first_order_reaction_decays_exponentially(evidence: Evidence, nu: float) -> None:
    exact = nu + (1.0 - nu) * np.exp(-0.01 * TIMES)
    found = remaining(slab(reaction("A", 0.01, products={"C": nu})))
    state(evidence, f"first order, residue {nu:g}", found, exact, 2e-5, "exp(-k t)")


@pytest.mark.parametrize(("order", "limit"), [(0.5, 4e-5), (1.5, 2e-6), (2.0, 4e-6)])
def test_reaction_of_order_n_follows_the_closed_form(
    evidence: Evidence, order: float, limit: float
) -> None:
    base = np.maximum(1.0 - (1.0 - order) * 0.01 * TIMES, 0.0)
    found = remaining(slab(reaction("A", 0.01, order=order)))
    exact = base ** (1.0 / (1.0 - order))
    state(evidence, f"order {order:g}", found, exact, limit, "(1 - (1-n) k t)^(1/(1-n))")


@pytest.mark.parametrize(("K", "limit"), [(1.0, 6e-5), (30.0, 6e-5)])
def test_autocatalysis_follows_the_logistic_function(
    evidence: Evidence, K: float, limit: float
) -> None:
    k = 0.02 / (1.0 + K)
    found = remaining(slab(reaction("A", k, catalysis=K)))
    exact = (1.0 + K) / (K + np.exp((1.0 + K) * k * TIMES))
    state(evidence, f"autocatalysis, K = {K:g}", found, exact, limit, "(1 + K)/(K + e^((1+K) k t))")


@pytest.mark.parametrize("order", [0.0, 0.3, 0.5, 0.9, 1.1, 2.0])
def test_rate_of_order_n_follows_the_closed_form_and_ends(order: float) -> None:
    # The step in which the reaction ends is left out.
    base = np.maximum(1.0 - (1.0 - order) * 0.01 * TIMES, 0.0)
    exact = np.where(base > 0.0, 0.01 * DEPTH * RHO * base ** (order / (1.0 - order)), 0.0)
    found = signal(slab(reaction("A", 0.01, order=order)), "mlr")
    gone = 1.0 / (1.0 - order) / 0.01 if order < 1.0 else np.inf
    away = (TIMES > 50.0) & (np.abs(TIMES - gone) > 15.0)
    assert found[away] == pytest.approx(exact[away], abs=2e-3 * exact.max())
    assert np.all(found[gone + 15.0 < TIMES] == 0.0)


def test_consecutive_reactions_follow_bateman(evidence: Evidence) -> None:
    # A -> 0.7 B -> 0.7 x 0.2 C with 0.02 and 0.01 per second.
    a = np.exp(-0.02 * TIMES)
    b = 0.7 * 0.02 * (a - np.exp(-0.01 * TIMES)) / (0.01 - 0.02)
    c = 0.2 * (0.7 * (1.0 - a) - b)
    first = reaction("A", 0.02, products={"B": 0.7})
    second = reaction("B", 0.01, products={"C": 0.2})
    material, exact = slab(first, second), a + b + c
    state(evidence, "A → 0.7 B → 0.14 C", remaining(material), exact, 6e-4, "Bateman")
    fine = remaining(material, Accuracy(longest_step_s=2.5))
    state(evidence, "A → 0.7 B → 0.14 C, steps to 2.5 s", fine, exact, 4e-5, "Bateman")


def test_intermediate_may_react_with_another_order(evidence: Evidence) -> None:
    # A -> 0.5 B at once, then B with order 2: u = 1/(1 + k t). At t = 0 A is still there.
    first = reaction("A", 1e3, products={"B": 0.5})
    found = remaining(slab(first, reaction("B", 0.01, order=2.0)))
    exact = 0.5 / (1.0 + 0.01 * TIMES)
    line = Line(TIMES[1:], found[1:], exact[1:])
    title = "isothermal slab: A → 0.5 B at once, B of order 2"
    evidence.curve(title, TIME, MASS, line, "exact: 0.5/(1 + k t)", 4e-5)


def test_competing_reactions_share_the_reactant_by_their_rates(evidence: Evidence) -> None:
    # A -> C with 0.01, A -> gas with 0.03 per second: a quarter becomes C.
    exact = 0.25 + 0.75 * np.exp(-0.04 * TIMES)
    found = remaining(slab(reaction("A", 0.01, products={"C": 1.0}), reaction("A", 0.03)))
    state(evidence, "competing A → C and A → gas", found, exact, 5e-4, "1/4 + 3/4 exp(-k t)")
