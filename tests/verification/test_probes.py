"""Temperatures inside a slab, which follow the material or stay where they are."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from cases import FAINT, Curve, Probes, inert_material, placed, run, slab_experiment
from exact import slab_with_foil
from terms import FOIL, SIMPLE, charring, specimen

from pyrofit.experiments import Gasification
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.model.material import Material
from pyrofit.solver.curves import Curves, Place, Request
from pyrofit.solver.reference.gasification import reference_gasification

Solver = Callable[..., Curves]


def fixed(depth: float) -> Place:
    return Place(depth, follows="fixture")


def _kernel(
    experiment: Gasification,
    material: Material,
    requests: Mapping[str, Request],
    probes_m: Probes,
) -> Curves:
    fine = Accuracy(cells=200, tolerance=1e-5)
    return run(experiment, material, requests, fine, {}, probes_m)


def _reference(
    experiment: Gasification,
    material: Material,
    requests: Mapping[str, Request],
    probes_m: Probes,
) -> Curves:
    asked = placed(requests, probes_m)
    curves = reference_gasification(experiment, material, {}, asked, Resolution(elements=400))
    assert curves.status.finished
    return curves


both = pytest.mark.parametrize("solve", [_kernel, _reference])
RHO, K, C, T0, DEPTH = 1200.0, 0.2, 1500.0, 293.15, 5e-3


def temperatures(
    solve: Solver, experiment: Gasification, material: Material, places: Probes, time: Curve
) -> Curve:
    """Temperatures [K] at places, shape (places, times)."""
    names = [f"probe_{n}" for n in range(len(places))]
    curves = solve(experiment, material, dict.fromkeys(names, Request(time)), places)
    return np.array([curves.signals[name] for name in names])


@both
@pytest.mark.parametrize("foil", [False, True])
def test_constant_flux_heats_an_inert_slab_at_every_place(solve: Solver, foil: bool) -> None:
    # Nothing moves: both kinds of place are one. Measured: kernel 0.0021 K, reference 0.0005 K.
    depths, time = (0.0, 0.4e-3, 1.7e-3, 3.3e-3, DEPTH), np.geomspace(5.0, 400.0, 30)
    copper = {"foil": FOIL} if foil else {}
    experiment = slab_experiment(DEPTH, {"flux_W_m2": 5e3 / FAINT}, **copper)
    places = (*depths, *map(fixed, depths))
    found = temperatures(solve, experiment, inert_material(emissivity=FAINT), places, time)
    M = 2e-4 * 8940.0 * 380.0 if foil else 0.0
    exact = [T0 + slab_with_foil(5e3, K, RHO * C, DEPTH, M, x, time) for x in depths]
    assert found == pytest.approx(np.array([*exact, *exact]), abs=0.004)


def _two_layers() -> tuple[Gasification, Material, float]:
    """A slab of two layers between gases at 600 K and 300 K, and its steady heat flux."""
    front = {"h_W_m2K": 50.0, "gas_temperature_K": 600.0}
    back = {"h_W_m2K": 20.0, "gas_temperature_K": 300.0}
    layers = [
        {"thickness_m": 1e-3, "composition": {"solid": 1.0}},
        {"thickness_m": 3e-3, "composition": {"board": 1.0}},
    ]
    plain = {"density_kg_m3": 500.0, "specific_heat_J_kgK": 800.0, "emissivity": 0.0}
    solid, board = ({"conductivity_W_mK": k, **plain} for k in (0.1, 2.0))
    material = Material.model_validate(
        {"components": {"solid": solid, "board": board}, "composition": {"solid": 1.0}}
    )
    experiment = slab_experiment(DEPTH, front, back)
    sample = {
        **experiment.sample.model_dump(),
        "layers": layers,
        "foil": {**FOIL, "contact_m2K_W": 0.01},
    }
    given: dict[str, Any] = {**experiment.model_dump(), "sample": sample}
    resistances = 1.0 / 50.0 + 1e-3 / 0.1 + 3e-3 / 2.0 + 0.01 + 1.0 / 20.0
    return Gasification.model_validate(given), material, 300.0 / resistances


@pytest.mark.parametrize("cells", [4, 50])
def test_interface_of_unlike_layers_is_exact_with_any_number_of_cells(cells: int) -> None:
    # In series: convection, two layers, the contact to a foil, convection.
    experiment, material, q = _two_layers()
    front = 600.0 - q / 50.0
    interface, back = front - q * 1e-3 / 0.1, 300.0 + q * (1.0 / 20.0 + 0.01)
    exact = [front, interface, back, interface, 0.5 * (front + interface), back]
    places = (0.0, Place(layer=1), Place(layer=2), 1e-3, fixed(0.5e-3), fixed(4e-3))
    time = np.array([3e4])

    def kernel(*case: Any) -> Curves:
        return run(*case[:3], Accuracy(cells=cells), {}, case[3])

    for solve in (kernel, _reference):
        found = temperatures(solve, experiment, material, places, time)
        assert found[:, 0] == pytest.approx(exact, abs=1e-3)


@both
@pytest.mark.parametrize("ratio", [0.5, 2.0], ids=["shrunk", "swollen"])
def test_fixture_stays_where_the_sample_shrinks_or_swells(solve: Solver, ratio: float) -> None:
    # All has become char of the same conductivity: a straight line between the gases.
    char = {"density_kg_m3": 1200.0 / ratio, "conductivity_W_mK": 0.2, "emissivity": 0.0}
    same = {"reactant": "V", "products": {"C": 1.0}, "A_1_s": 1e8, "E_J_mol": 8e4}
    material = charring(same, virgin={"emissivity": 0.0}, char=char)
    back = {"h_W_m2K": 100.0, "gas_temperature_K": 600.0}
    front = {"h_W_m2K": 100.0, "gas_temperature_K": 700.0, "wall_temperature_K": 300.0}
    experiment = specimen(0.0, back, front)
    now = ratio * DEPTH
    q = 100.0 / (0.02 + now / 0.2)
    high, slope = 700.0 - q / 100.0, q / 0.2
    depths = np.array([0.0, 1e-3, 2.4e-3, 2.6e-3, 4e-3, DEPTH])
    moved = high - slope * ratio * depths
    below = np.maximum(now - (DEPTH - depths), 0.0)
    stayed = high - slope * below
    places = (*map(float, depths), *(fixed(float(x)) for x in depths))
    found = temperatures(solve, experiment, material, places, np.array([2e4]))
    assert found[:, 0] == pytest.approx(np.concatenate((moved, stayed)), abs=0.01)
    # Of the places that stay, the outer ones see the front where the sample is half as thick.
    assert (found[6:9, 0] == pytest.approx(high, abs=0.01)) == (ratio < 1.0)


COURSES: dict[str, tuple[Material, dict[str, Any]]] = {
    # Largest differences measured [K]: 0.077, 0.069, 0.059, 0.077.
    "char": (charring(), {}),
    "nothing is left": (charring({**SIMPLE, "products": {}}), {"back": {}}),
    "swelling": (charring(char={"density_kg_m3": 100.0, "expansion": 1.5}), {}),
    "foil with a contact": (charring(), {"foil": {**FOIL, "contact_m2K_W": 5e-3}}),
}


@pytest.mark.parametrize("name", COURSES)
def test_kernel_agrees_with_the_reference_while_the_front_moves(name: str) -> None:
    material, more = COURSES[name]
    depths = (0.8e-3, 2.5e-3, 4.2e-3)
    places = (*depths, *map(fixed, depths), Place(layer=1))
    # After 336 s nothing is left of one of them, which takes the reference 100 s.
    end = 336.0 if name == "nothing is left" else 400.0
    case = specimen(**more), material, places, np.arange(5.0, end, 5.0)
    kernel, exact = (temperatures(solve, *case) for solve in (_kernel, _reference))
    assert np.ptp(exact[3:6] - exact[:3]) > 10.0
    assert np.abs(kernel - exact).max(axis=1) == pytest.approx(np.zeros(7), abs=0.1)
