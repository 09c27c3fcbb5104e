"""TGA against exact solutions

The temperature rises at a constant rate β, a reaction has the rate constant k = A exp(-E/(R T)).
Where reactions do not feed each other the mass follows from the integral of k over time, X = A/β
[T E₂(E/(R T))], with the exponential integral E₂ (Abramowitz & Stegun 5.1.4): exp(-X) for first
order, (1 - (1-n) X)^(1/(1-n)) for order n.
Consecutive and competing reactions are compared with a stiff integrator (LSODA) at relative
tolerance 1e-12; there the error goes with the square of the temperature step.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from cases import KINETICS, Curve, powder, table_3, tga_fraction
from evidence import MASS, TEMPERATURE, Axis, Evidence, Line
from scipy.integrate import solve_ivp
from scipy.special import expn

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.solver.heated import COUPLED_STEP

T = np.linspace(300.0, 850.0, 551)
RATES = (1.0, 10.0, 50.0)
FAST = {"A_1_s": 1e8, "E_J_mol": 1.1e5}
SLOW = {"A_1_s": 1e11, "E_J_mol": 1.6e5}
STEEP = {"A_1_s": 1e13, "E_J_mol": 1.7e5}
E2 = "exact: exponential integral E₂"
LSODA = "stiff integrator: LSODA, rtol 1e-12"
STEP = Axis("temperature step", "K")
ERROR = Axis("largest difference", "-")


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
        rtol=1e-12,
        atol=1e-15,
    )
    assert solution.success
    return solution.y


def k(kinetics: dict[str, float], temperature: float) -> float:
    activation = kinetics["E_J_mol"] / GAS_CONSTANT
    return float(kinetics["A_1_s"] * np.exp(-activation / temperature))


def catalysed(order: float, K: float) -> Material:
    reaction = {"reactant": "B", "products": {"C": 0.2}, "order": order, "catalysis": K}
    return powder("BC", {"B": 1.0}, {**reaction, **SLOW})


def exact_catalysed(order: float, K: float, beta: float) -> Any:
    def rates(temperature: float, y: Any) -> list[float]:
        u = min(max(y[0], 0.0), 1.0)
        rate = k(SLOW, temperature) * u**order * (1.0 + K * (1.0 - u))
        return [-rate, 0.2 * rate]

    return stiff(rates, [1.0, 0.0], beta).sum(axis=0)


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


NETWORKS: dict[str, tuple[Material, Callable[[float], Any]]] = {
    "consecutive reactions": (consecutive(1.0), lambda b: exact_consecutive(1.0, b)),
    "consecutive reaction of order 1.7": (consecutive(1.7), lambda b: exact_consecutive(1.7, b)),
    "competing reactions": (competing((1.0, 1.0)), lambda b: exact_competing((1.0, 1.0), b)),
    "autocatalysis of order 1.7, K = 20": (
        catalysed(1.7, 20.0),
        lambda b: exact_catalysed(1.7, 20.0, b),
    ),
    "competing reactions of orders 1.5 and 0.7": (
        competing((1.5, 0.7)),
        lambda b: exact_competing((1.5, 0.7), b),
    ),
}


def label(beta: float) -> str:
    return f"{beta:.0f} K/min"


def by_rate(material: Material, exact: Callable[[float], Curve]) -> Any:
    """Our line and the exact one at each heating rate."""
    return {label(b): Line(T, tga_fraction(material, b, T), exact(b)) for b in RATES}


def test_parallel_first_order_reactions_follow_the_exponential_integral(evidence: Evidence) -> None:
    def exact(beta: float) -> Curve:
        shares = ((KINETICS["A"], 0.025), (KINETICS["B"], 0.975))
        left: Curve = sum(0.999 * s * np.exp(-conversion(k, beta, T)) for k, s in shares) + 1e-3
        return left

    lines = by_rate(table_3(), exact)
    title = "two parallel first-order reactions (Table 3)"
    evidence.curve(title, TEMPERATURE, MASS, lines, E2, 1e-6)


@pytest.mark.parametrize("beta", RATES)
def test_sparse_output_is_as_accurate_as_dense(beta: float) -> None:
    sparse = tga_fraction(table_3(), beta, T[::50])
    assert sparse == pytest.approx(tga_fraction(table_3(), beta, T)[::50], abs=1e-12)


@pytest.mark.parametrize("order", [0.5, 2.0])
def test_reaction_of_order_n_follows_the_closed_form(evidence: Evidence, order: float) -> None:
    def exact(beta: float) -> Curve:
        base = np.maximum(1.0 - (1.0 - order) * conversion(SLOW, beta, T), 0.0)
        left: Curve = base ** (1.0 / (1.0 - order))
        return left

    material = powder("B", {"B": 1.0}, {"reactant": "B", "order": order, **SLOW})
    lines = by_rate(material, exact)
    evidence.curve(f"one reaction of order {order:g}", TEMPERATURE, MASS, lines, E2, 1e-6)


def test_autocatalysis_follows_the_closed_form(evidence: Evidence) -> None:
    def exact(beta: float) -> Curve:
        passed = np.exp(np.minimum(21.0 * conversion(SLOW, beta, T), 700.0))
        left: Curve = 0.2 + 0.8 * 21.0 / (20.0 + passed)
        return left

    lines = by_rate(catalysed(1.0, 20.0), exact)
    evidence.curve("autocatalysis, K = 20", TEMPERATURE, MASS, lines, E2, 1e-6)


@pytest.mark.parametrize("name", NETWORKS)
def test_network_follows_a_stiff_integrator(evidence: Evidence, name: str) -> None:
    lines = by_rate(*NETWORKS[name])
    evidence.curve(name, TEMPERATURE, MASS, lines, LSODA, 1e-6)


def test_error_falls_with_the_square_of_the_temperature_step(evidence: Evidence) -> None:
    steps = np.array([8.0, 4.0, 2.0, 1.0])

    def errors(name: str) -> tuple[Curve, Curve]:
        material, exact = NETWORKS[name]
        right = exact(10.0)
        curves = [tga_fraction(material, 10.0, T, Accuracy(tga_step_K=step)) for step in steps]
        return steps, np.array([np.abs(curve - right).max() for curve in curves])

    lines = {name: errors(name) for name in NETWORKS}
    evidence.order("TGA, order in the temperature step", STEP, ERROR, lines, LSODA, 0.1)


def test_one_reaction_written_as_two_halves_is_the_same_reaction(evidence: Evidence) -> None:
    half = {"A_1_s": 0.5 * SLOW["A_1_s"], "E_J_mol": SLOW["E_J_mol"]}
    pair = ({"reactant": "B", "products": {"C": 0.1}, **half},) * 2
    whole = powder("BC", {"B": 1.0}, {"reactant": "B", "products": {"C": 0.1}, **SLOW})
    halves = tga_fraction(powder("BC", {"B": 1.0}, *pair), 10.0, T)
    same_steps = Accuracy(tga_step_K=COUPLED_STEP)
    gap = float(np.abs(halves - tga_fraction(whole, 10.0, T, same_steps)).max())
    title = "a reaction written as two halves"
    evidence.number(title, gap, 1e-12, "largest difference", "the reaction as one")


def test_solid_products_alone_leave_the_mass_unchanged(evidence: Evidence) -> None:
    material = powder(
        "ABC",
        {"A": 0.8, "B": 0.2},
        {"reactant": "A", "products": {"B": 0.7, "C": 0.3}, **FAST},
        {"reactant": "A", "products": {"C": 1.0}, "order": 0.7, **STEEP},
        {"reactant": "B", "products": {"C": 1.0}, "order": 1.7, **SLOW},
    )
    change = float(np.abs(tga_fraction(material, 10.0, T) - 1.0).max())
    title = "reactions among solids keep the mass"
    evidence.number(title, change, 1e-12, "largest change of the mass fraction", "balance")


def test_residue_of_a_burnt_sample_is_the_product_of_the_yields(evidence: Evidence) -> None:
    gap = float(abs(tga_fraction(consecutive(1.0), 10.0, T)[-1] - 0.14))
    title = "residue of A → 0.7 B → 0.14 C"
    evidence.number(title, gap, 1e-12, "difference of the mass fraction", "exact: 0.7 x 0.2")
