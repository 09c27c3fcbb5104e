"""Small samples whose reactions need oxygen, against closed forms and the reference solver."""

from typing import Any

import numpy as np
import pytest
from cases import powder

from pyrofit.constants import GAS_CONSTANT
from pyrofit.experiments import Dsc, Mcc, Tga
from pyrofit.experiments.heated.simulate import reference, simulate, synthetic
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_tgas
from pyrofit.solver.curves import Request
from pyrofit.solver.outputs import FRACTION_RATE, HEAT_FLOW, HEAT_RELEASE, MASS_FRACTION

HELD_K = 700.0
TIME = np.linspace(0.0, 3000.0, 301)
HELD = np.full(TIME.size, HELD_K)
E, A, X, N = 1.3e5, 6e6, 0.209, 0.8
K = A * np.exp(-E / (GAS_CONSTANT * HELD_K)) * X**N
BURNS = {"reactant": "C", "products": {"S": 0.1}, "A_1_s": A, "E_J_mol": E}
HEAT, COMBUSTION = -3.2e7, 9e6
OXIDATION = {**BURNS, "heat_of_reaction_J_kg": HEAT, "heat_of_combustion_J_kg": COMBUSTION}
PYROLYSIS = {"reactant": "V", "products": {"C": 0.3}, "A_1_s": 1e11, "E_J_mol": 1.6e5}


def char(**oxidation: Any) -> Material:
    """Char that burns to a tenth of ash."""
    return powder("CS", {"C": 1.0}, {**OXIDATION, "oxygen_order": N, **oxidation})


def charring(order: float | str) -> Material:
    """A material that leaves char, which burns."""
    burns = {**OXIDATION, "oxygen_order": order}
    return powder("VCS", {"V": 1.0}, PYROLYSIS, burns)


def furnace(kind: type[HeatedExperiment], signal: str, **given: Any) -> Any:
    """A test in air, or in a gas of another share of oxygen."""
    base = {"kind": kind.__name__.lower(), "heating_rate_K_min": 20.0, "oxygen": X}
    return kind.model_validate({**base, "signals": {signal: {"file": "synthetic"}}, **given})


def held(output: str) -> Request:
    return Request(TIME, temperature_K=HELD, output=output)


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_mass_falls_by_the_closed_form_while_char_burns(order: float) -> None:
    tga = furnace(Tga, "mass_fraction")
    ((curves,),) = simulate_tgas([tga], char(order=order), {}, [held(MASS_FRACTION)])
    left = np.exp(-K * TIME) if order == 1.0 else 1.0 / (1.0 + K * TIME)
    np.testing.assert_allclose(curves.signals[MASS_FRACTION], 0.1 + 0.9 * left, atol=1e-9)
    np.testing.assert_allclose(curves.signals[FRACTION_RATE], 0.9 * K * left**order, rtol=1e-7)
    assert 0.11 < curves.signals[MASS_FRACTION][-1] < 0.6


def test_heat_of_burning_char_is_that_of_the_closed_form() -> None:
    mcc = furnace(Mcc, "specific_heat_release_rate", response_s=0.0)
    both = [furnace(Dsc, "heat_flow"), mcc]
    found = simulate_tgas(both, char(), {}, [held(HEAT_FLOW), held(HEAT_RELEASE)])
    rate = K * np.exp(-K * TIME)
    np.testing.assert_allclose(found[0][0].signals[HEAT_FLOW], HEAT * rate, rtol=1e-7)
    gas = (0.9 * COMBUSTION - HEAT) * rate
    np.testing.assert_allclose(found[1][0].signals[HEAT_RELEASE], gas, rtol=1e-7)


def test_each_gas_has_its_own_curve_and_without_oxygen_nothing_burns() -> None:
    shares = [X, 0.0, 0.05, X]
    tests = [furnace(Tga, "mass_fraction", oxygen=share) for share in shares]
    curves = simulate_tgas(tests, char(), {}, [held(MASS_FRACTION)] * 4)
    masses = [of[0].signals[MASS_FRACTION] for of in curves]
    for share, mass in zip(shares, masses, strict=True):
        k = K * (share / X) ** N
        np.testing.assert_allclose(mass, 0.1 + 0.9 * np.exp(-k * TIME), atol=1e-9)
    assert np.all(masses[1] == 1.0)
    assert np.array_equal(masses[0], masses[3])


def test_a_reaction_without_oxygen_order_has_the_same_bits_in_any_gas() -> None:
    material = charring(0.0)
    asked = synthetic(furnace(Tga, "mass_fraction"), ["mass_fraction"])["mass_fraction"]
    inert, air = (
        simulate_tgas([furnace(Tga, "mass_fraction", oxygen=share)], material, {}, [asked])[0][0]
        for share in (0.0, X)
    )
    assert np.array_equal(inert.signals[MASS_FRACTION], air.signals[MASS_FRACTION])


@pytest.mark.parametrize(
    ("kind", "signal"),
    [(Tga, "mass_fraction"), (Dsc, "heat_flow"), (Mcc, "specific_heat_release_rate")],
)
def test_both_solvers_agree_on_char_that_forms_and_burns(
    kind: type[HeatedExperiment], signal: str
) -> None:
    given = furnace(kind, signal, oxygen="x", end_temperature_K=1000.0)
    asked = synthetic(given, [signal])
    values = {"n": N, "x": X}
    material = charring("n")
    ((curves,),) = simulate([given], material, values, [asked], Accuracy())
    other = reference(given, material, values, asked, Resolution()).signals[signal]
    size = float(np.ptp(other))
    np.testing.assert_allclose(curves.signals[signal] / size, other / size, atol=1e-4)
    inert = reference(given, material, values | {"x": 0.0}, asked, Resolution()).signals[signal]
    assert np.max(np.abs(inert - other)) > 0.1 * size


def test_sets_with_a_share_of_their_own_have_the_bits_of_single_runs() -> None:
    given = furnace(Tga, "mass_fraction", oxygen="x", end_temperature_K=1000.0)
    asked = synthetic(given, ["mass_fraction"])["mass_fraction"]
    shares = np.linspace(0.0, 0.4, 9)
    together = simulate_tgas([given], charring(N), {"x": shares}, [asked], sets=9)[0]
    for share, curves in zip(shares.tolist(), together, strict=True):
        alone = simulate_tgas([given], charring(N), {"x": share}, [asked])[0][0]
        assert np.array_equal(alone.signals[MASS_FRACTION], curves.signals[MASS_FRACTION])
