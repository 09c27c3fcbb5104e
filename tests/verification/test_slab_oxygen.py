"""Char of a slab that burns in depth, against closed forms and the reference solver.

The volume fraction of oxygen falls as X exp(-x/L) below the surface. A slab of char at one
temperature, of a reaction without heat, then has closed forms, with K = k X^n and b = n/L. Where
residue keeps the volume, char decays at each depth by exp(-K t e^{-b x}). Where nothing is left,
the surface recedes: dD/dt = -K/b (1 - e^{-b D}).
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from cases import run, slab_experiment
from pydantic import ValidationError
from scipy.special import exp1
from terms import HEATED, SLOW, charring, specimen

from pyrofit.constants import AIR_HEAT_CAPACITY, OXYGEN_OVER_AIR
from pyrofit.experiments import Cone, Gasification
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_gasification, simulate_gasifications
from pyrofit.solver.arrays import Status
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.reference.gasification import reference_gasification

T, RHO, DEPTH = 700.0, 300.0, 5e-3
X, N, L, RATE_1_S = 0.209, 0.8, 1e-3, 0.05
K, B = RATE_1_S * X**N, N / L
TIMES = np.linspace(0.0, 1200.0, 121)
AROUND = {"h_W_m2K": 10.0, "gas_temperature_K": T, "wall_temperature_K": T}
FINE = Accuracy(cells=150, tolerance=1e-4, longest_step_s=4.0)
CHAR_BURNS = {"reactant": "C", "A_1_s": 2e3, "E_J_mol": 8e4, "oxygen_order": N}
PYROLYSIS = {"reactant": "V", "products": {"C": 0.2}, **SLOW, **HEATED}
Solver = Callable[..., Curves]


def kernel(experiment: Any, material: Material, requests: Any, values: Any = None) -> Curves:
    """A finished run, whose mass closes."""
    return run(experiment, material, requests, FINE, values or {})


def reference(experiment: Any, material: Material, requests: Any, values: Any = None) -> Curves:
    fine = Resolution(elements=200)
    return reference_gasification(experiment, material, values or {}, requests, fine)


both = pytest.mark.parametrize("solve", [kernel, reference])


def char(residue: float = 0.0, heat: float = 0.0, **changed: float) -> Material:
    """Char that burns and leaves a residue of its own volume, or nothing."""
    own = {"conductivity_W_mK": 0.2, "specific_heat_J_kgK": 1500.0}
    burns = {"reactant": "C", "reference_temperature_K": T, "reference_rate_1_s": RATE_1_S}
    burns |= {"E_J_mol": 1.5e5, "oxygen_order": N, "oxygen_depth_m": L}
    burns |= ({"products": {"S": residue}} if residue else {}) | changed
    return Material.model_validate(
        {
            "components": {
                "C": {"density_kg_m3": RHO, **own},
                "S": {"density_kg_m3": (residue or 1.0) * RHO, **own},
            },
            "reactions": {"burns": {**burns, "heat_of_reaction_J_kg": heat}},
            "composition": {"C": 1.0},
        }
    )


def warm(kind: str = "gasification", **given: Any) -> Any:
    """A slab at the temperature of its surroundings, in air."""
    slab = slab_experiment(DEPTH, AROUND, AROUND | {"emissivity": 0.9}, initial_temperature_K=T)
    kinds = {"gasification": Gasification, "cone": Cone}
    return kinds[kind].model_validate(slab.model_dump() | {"kind": kind, "oxygen": X, **given})


def mass_of(solve: Solver, experiment: Any, material: Material) -> Any:
    return solve(experiment, material, {"mass": Request(TIMES)}).signals["mass"]


@both
def test_char_decays_slower_the_deeper_it_lies(solve: Solver) -> None:
    share = 0.3
    late = K * np.maximum(TIMES, 1e-12)
    left = (exp1(late * np.exp(-B * DEPTH)) - exp1(late)) / (B * DEPTH)
    exact = RHO * DEPTH * (share + (1.0 - share) * left)
    found = mass_of(solve, warm(), char(residue=share))
    assert 0.4 < exact[-1] / exact[0] < 0.8
    # Measured: see the tolerance.
    np.testing.assert_allclose(found, exact, atol=1e-4 * exact[0])


@both
def test_surface_recedes_where_nothing_is_left(solve: Solver) -> None:
    exact = RHO / B * np.log1p(np.expm1(B * DEPTH) * np.exp(-K * TIMES))
    found = mass_of(solve, warm(), char())
    assert exact[-1] < 0.1 * exact[0]
    np.testing.assert_allclose(found, exact, atol=1e-3 * exact[0])


@both
@pytest.mark.parametrize("rate_1_s", [RATE_1_S, 1e3])
def test_convection_limits_the_supply_of_oxygen(solve: Solver, rate_1_s: float) -> None:
    """k X_s and the supply S (X - X_s) are in series: t = t(kinetics) + t(supply)."""
    use, supply = 2.67, AROUND["h_W_m2K"] / AIR_HEAT_CAPACITY * OXYGEN_OVER_AIR
    first_order = char(oxygen_order=1.0, oxygen_use=use, reference_rate_1_s=rate_1_s)
    found = mass_of(solve, warm(), first_order)
    d = found / RHO
    kinetics = np.log(np.expm1(DEPTH / L) / np.expm1(d / L)) / (rate_1_s * X)
    exact = kinetics + use * RHO * (DEPTH - d) / (supply * X)
    assert found[-1] < 0.6 * found[0]
    np.testing.assert_allclose(exact, TIMES, atol=1.0)


@both
def test_flame_keeps_oxygen_away(solve: Solver) -> None:
    flame = {"ignition_s": 200.0, "ends_s": 600.0}
    found = mass_of(solve, warm("cone", flame=flame), char())
    open_s = np.minimum(TIMES, 200.0) + np.maximum(TIMES - 600.0, 0.0)
    exact = RHO / B * np.log1p(np.expm1(B * DEPTH) * np.exp(-K * open_s))
    np.testing.assert_allclose(found, exact, atol=1e-3 * exact[0])
    inside = (TIMES >= 200.0) & (TIMES <= 600.0)
    assert np.ptp(found[inside]) < 1e-9 * exact[0]


@both
def test_calorimeter_shows_the_heat_of_burning_char(solve: Solver) -> None:
    heat = 3.0e5
    bins = Request(TIMES[1:] - 5.0, 10.0)
    flame = {"ignition_s": 200.0, "ends_s": 600.0}
    asked = {"heat_release_rate": bins, "mlr": bins}
    found = solve(warm("cone", flame=flame), char(heat=-heat), asked).signals
    shown = found["heat_release_rate"]
    np.testing.assert_allclose(shown, heat * found["mlr"], rtol=1e-6, atol=1e-6 * shown.max())
    dark = (bins.time_s > 200.0) & (bins.time_s < 600.0)
    assert np.all(shown[dark] < 1e-9 * shown.max())
    assert shown[~dark].min() > 0.0


def oxidised(**given: Any) -> Gasification:
    return Gasification.model_validate(specimen(**given).model_dump() | {"oxygen": "x"})


def burning(n: float | str = N, heat: float = -4.0e6, use: float | str = 0.0) -> Material:
    burns = {**CHAR_BURNS, "oxygen_order": n, "heat_of_reaction_J_kg": heat, "oxygen_use": use}
    return charring(PYROLYSIS, burns)


BINS = Request(np.arange(2.5, 900.0, 5.0), 5.0)
ASKED = {
    "mlr": BINS,
    "back_temperature": Request(BINS.time_s),
    "front_temperature": Request(BINS.time_s),
}


def test_both_solvers_agree_on_char_that_forms_and_burns() -> None:
    values = {"x": X}
    ours = kernel(oxidised(), burning(), ASKED, values)
    other = reference(oxidised(), burning(), ASKED, values)
    inert = kernel(oxidised(), burning(), ASKED, {"x": 0.0})
    assert ours.status.finished
    assert other.status.finished
    for name, tolerance in (("mlr", 5e-3), ("back_temperature", 1e-3), ("front_temperature", 2e-3)):
        size = float(np.ptp(other.signals[name]))
        off = ours.signals[name] - other.signals[name]
        assert np.sqrt(np.mean(off**2)) < tolerance * size, name
        assert np.max(np.abs(inert.signals[name] - ours.signals[name])) > 0.01 * size, name
    assert ours.energy_error < 1e-4


def test_both_solvers_agree_on_carbon_whose_oxygen_is_short() -> None:
    values, carbon = {"x": X}, burning(1.0, -32.8e6, 2.67)
    ours = kernel(oxidised(), carbon, ASKED, values)
    other = reference(oxidised(), carbon, ASKED, values)
    endless = simulate_gasification(oxidised(), burning(1.0, -32.8e6), values, ASKED)
    assert ours.status.finished
    assert other.status.finished
    assert endless.status is Status.DIVERGED
    for name, tolerance in (("mlr", 5e-3), ("back_temperature", 2e-3), ("front_temperature", 2e-3)):
        size = float(np.ptp(other.signals[name]))
        off = ours.signals[name] - other.signals[name]
        assert np.sqrt(np.mean(off**2)) < tolerance * size, name
    assert ours.energy_error < 1e-4


def test_oxidation_that_does_not_run_leaves_the_bits_of_the_inert_slab() -> None:
    plain = charring(PYROLYSIS)
    still = charring(PYROLYSIS, {**CHAR_BURNS, "A_1_s": None, **NEVER})
    hot = {"flux_kW_m2": 70.0, "back": {}}
    base = simulate_gasification(specimen(**hot), plain, {}, ASKED)
    for experiment, material in ((oxidised(**hot), still), (specimen(**hot), burning())):
        found = simulate_gasification(experiment, material, {"x": X}, ASKED)
        assert found.status is base.status is Status.OK
        for name, curve in base.signals.items():
            assert np.array_equal(found.signals[name], curve), name


NEVER = {"reference_temperature_K": 700.0, "reference_rate_1_s": 0.0}


def test_sets_have_the_bits_of_single_runs() -> None:
    shares = np.array([0.0, 0.01, 0.05, 0.1, 0.209, 0.3, 0.5, 1.0, 0.209])
    orders = np.linspace(0.5, 1.3, 9)
    uses = np.array([0.0, 1.3, 2.67] * 3)
    slab, material = oxidised(), burning("n", use="s")
    given = {"x": shares, "n": orders, "s": uses}
    together = simulate_gasifications(slab, material, given, ASKED, sets=9)
    for k, curves in enumerate(together):
        values = {name: float(of[k]) for name, of in given.items()}
        alone = simulate_gasification(slab, material, values, ASKED)
        assert curves.status.finished
        for name in ASKED:
            assert np.array_equal(curves.signals[name], alone.signals[name]), (values, name)


def test_cone_with_oxygen_needs_a_flame() -> None:
    with pytest.raises(ValidationError, match="the test has no flame"):
        warm("cone")
