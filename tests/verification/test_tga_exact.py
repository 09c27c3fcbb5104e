"""TGA against closed forms and a stiff integrator."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from cases import KINETICS, Curve, reference, tga_fraction
from scipy.integrate import solve_ivp
from scipy.special import expn

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model.material import Material
from pyrofit.simulate import Accuracy

T = np.linspace(300.0, 850.0, 551)
RATES = (1.0, 10.0, 50.0)
FAST = {"A_1_s": 1e8, "E_J_mol": 1.1e5}
SLOW = {"A_1_s": 1e11, "E_J_mol": 1.6e5}
STEEP = {"A_1_s": 1e13, "E_J_mol": 1.7e5}
COMPONENT = {"density_kg_m3": 1e3, "conductivity_W_mK": 0.2, "specific_heat_J_kgK": 1e3}


def powder(names: str, composition: dict[str, Any], *reactions: dict[str, Any]) -> Material:
    return Material.model_validate(
        {
            "components": dict.fromkeys(names, COMPONENT),
            "reactions": {str(j): reaction for j, reaction in enumerate(reactions)},
            "composition": composition,
        }
    )


def table_3() -> Material:
    return powder(
        "ABC",
        {"A": 0.025, "B": "rest"},
        {"reactant": "A", "products": {"C": 1e-3}, **KINETICS["A"]},
        {"reactant": "B", "products": {"C": 1e-3}, **KINETICS["B"]},
    )


def conversion(kinetics: dict[str, float], rate_K_min: float, temperature: Curve) -> Curve:
    """The integral of k dt from the first temperature, by T E2(E/(R T))."""
    activation = kinetics["E_J_mol"] / GAS_CONSTANT
    integral = temperature * expn(2, activation / temperature)
    return kinetics["A_1_s"] * 60.0 / rate_K_min * (integral - integral[0])


def stiff(rates: Callable[[float, Any], list[float]], start: list[float], beta: float) -> Any:
    """Components' masses at ``T`` by LSODA, shape (states, points)."""
    time = (T - T[0]) * 60.0 / beta
    solution = solve_ivp(
        lambda t, y: rates(T[0] + beta / 60.0 * t, y),
        (0.0, time[-1]),
        start,
        method="LSODA",
        t_eval=time,
        rtol=1e-11,
        atol=1e-14,
    )
    assert solution.success
    return solution.y


def k(kinetics: dict[str, float], temperature: float) -> float:
    activation = kinetics["E_J_mol"] / GAS_CONSTANT
    return float(kinetics["A_1_s"] * np.exp(-activation / temperature))


def consecutive(order: float) -> Material:
    return powder(
        "ABC",
        {"A": 1.0},
        {"reactant": "A", "products": {"B": 0.7}, **FAST},
        {"reactant": "B", "products": {"C": 0.2}, "order": order, **SLOW},
    )


def exact_consecutive(order: float, beta: float) -> Any:
    def rates(temperature: float, y: Any) -> list[float]:
        a, b, _, formed = y
        first = k(FAST, temperature) * a
        u = min(max(b, 0.0) / formed, 1.0) if formed > 1e-25 else 1.0
        second = k(SLOW, temperature) * formed * u**order
        return [-first, 0.7 * first - second, 0.2 * second, 0.7 * first]

    return stiff(rates, [1.0, 0.0, 0.0, 0.0], beta)[:3].sum(axis=0)


def competing(orders: tuple[float, float]) -> Material:
    return powder(
        "AC",
        {"A": 1.0},
        {"reactant": "A", "products": {"C": 0.6}, "order": orders[0], **FAST},
        {"reactant": "A", "order": orders[1], **STEEP},
    )


def exact_competing(orders: tuple[float, float], beta: float) -> Any:
    def rates(temperature: float, y: Any) -> list[float]:
        u = max(y[0], 0.0)
        first = k(FAST, temperature) * u ** orders[0]
        second = k(STEEP, temperature) * u ** orders[1]
        return [-first - second, 0.6 * first]

    return stiff(rates, [1.0, 0.0], beta).sum(axis=0)


def errors(material: Material, exact: Curve, beta: float, steps: tuple[float, ...]) -> list[float]:
    curves = [tga_fraction(material, beta, T, Accuracy(tga_step_K=step)) for step in steps]
    return [float(np.abs(curve - exact).max()) for curve in curves]


@pytest.mark.parametrize("beta", RATES)
def test_parallel_first_order_reactions_follow_the_exponential_integral(beta: float) -> None:
    # Measured: 9.6e-10, 5.5e-10, 3.6e-10 at 1, 10, 50 K/min.
    exact = 1e-3 + sum(
        0.999 * share * np.exp(-conversion(KINETICS[name], beta, T))
        for name, share in (("A", 0.025), ("B", 0.975))
    )
    assert np.abs(tga_fraction(table_3(), beta, T) - exact).max() <= 1e-6


@pytest.mark.parametrize("beta", RATES)
def test_sparse_output_is_as_accurate_as_dense(beta: float) -> None:
    sparse = tga_fraction(table_3(), beta, T[::50])
    assert sparse == pytest.approx(tga_fraction(table_3(), beta, T)[::50], abs=1e-12)


@pytest.mark.parametrize("order", [0.5, 2.0])
@pytest.mark.parametrize("beta", RATES)
def test_reaction_of_order_n_follows_the_closed_form(order: float, beta: float) -> None:
    # u^(1-n) = 1 - (1 - n) X; measured: at most 1.3e-9.
    material = powder("B", {"B": 1.0}, {"reactant": "B", "order": order, **SLOW})
    base = np.maximum(1.0 - (1.0 - order) * conversion(SLOW, beta, T), 0.0)
    exact = base ** (1.0 / (1.0 - order))
    assert np.abs(tga_fraction(material, beta, T) - exact).max() <= 1e-6


@pytest.mark.parametrize("beta", [10.0, 50.0])
def test_consecutive_reactions_converge_with_second_order(beta: float) -> None:
    # Measured at 10 (50) K/min: 5.7e-6 (7.6e-6) at the default 1 K, order 2.00.
    found = errors(consecutive(1.0), exact_consecutive(1.0, beta), beta, (1.0, 0.5, 0.25))
    assert found[0] <= 1.5 * 7.6e-6
    assert np.log2(found[0] / found[1]) >= 1.8
    assert np.log2(found[1] / found[2]) >= 1.8


@pytest.mark.parametrize("beta", [10.0, 50.0])
def test_consecutive_reaction_of_order_n_converges_with_second_order(beta: float) -> None:
    # Measured at 10 (50) K/min with order 1.7: 5.3e-6 (7.0e-6) at 1 K, order 2.00.
    found = errors(consecutive(1.7), exact_consecutive(1.7, beta), beta, (1.0, 0.5))
    assert found[0] <= 1.5 * 7.0e-6
    assert np.log2(found[0] / found[1]) >= 1.8


@pytest.mark.parametrize("beta", [10.0, 50.0])
def test_competing_first_order_reactions_converge_with_second_order(beta: float) -> None:
    # Measured at 10 (50) K/min: 9.7e-6 (1.04e-5) at 1 K, order 2.00.
    orders = (1.0, 1.0)
    found = errors(competing(orders), exact_competing(orders, beta), beta, (1.0, 0.5, 0.25))
    assert found[0] <= 1.5 * 1.04e-5
    assert np.log2(found[0] / found[1]) >= 1.8
    assert np.log2(found[1] / found[2]) >= 1.8


def test_competing_reactions_of_other_orders_converge_with_second_order() -> None:
    # Measured with orders 1.5 and 0.7: 4.1e-5 at 1 K, order 2.01.
    orders = (1.5, 0.7)
    found = errors(competing(orders), exact_competing(orders, 10.0), 10.0, (1.0, 0.5))
    assert found[0] <= 1.5 * 4.1e-5
    assert np.log2(found[0] / found[1]) >= 1.8


def test_one_reaction_written_as_two_halves_is_the_same_reaction() -> None:
    half = {"A_1_s": 0.5 * SLOW["A_1_s"], "E_J_mol": SLOW["E_J_mol"]}
    pair = ({"reactant": "B", "products": {"C": 0.1}, **half},) * 2
    whole = powder("BC", {"B": 1.0}, {"reactant": "B", "products": {"C": 0.1}, **SLOW})
    halves = tga_fraction(powder("BC", {"B": 1.0}, *pair), 10.0, T)
    assert halves == pytest.approx(tga_fraction(whole, 10.0, T), abs=1e-12)


def test_solid_products_alone_leave_the_mass_unchanged() -> None:
    # Measured: 7e-16, while A becomes B becomes C and A becomes C directly.
    material = powder(
        "ABC",
        {"A": 0.8, "B": 0.2},
        {"reactant": "A", "products": {"B": 0.7, "C": 0.3}, **FAST},
        {"reactant": "A", "products": {"C": 1.0}, "order": 0.7, **STEEP},
        {"reactant": "B", "products": {"C": 1.0}, "order": 1.7, **SLOW},
    )
    assert np.abs(tga_fraction(material, 10.0, T) - 1.0).max() <= 1e-12


def test_residue_of_a_burnt_sample_is_the_product_of_the_yields() -> None:
    # A -> 0.7 B -> 0.7 x 0.2 C.
    assert tga_fraction(consecutive(1.0), 10.0, T)[-1] == pytest.approx(0.14, abs=1e-12)


@pytest.mark.parametrize("beta", RATES)
def test_table_3_curves_of_fds_agree(beta: float) -> None:
    # Measured max |dm| at 1, 10, 50 K/min: 1.4e-5, 1.6e-5, 2.1e-5 (a shift of 0.001 K). Below about
    # 1 % mass FDS deletes the layer.
    curve = reference("fds", f"tga_table3_{beta:.0f}K")
    curve = curve[curve["mass_fraction"] > 0.01]
    temperature = curve["T_C"].to_numpy() + 273.15
    ours = tga_fraction(table_3(), beta, temperature)
    assert np.abs(ours - curve["mass_fraction"]).max() <= 3e-5
