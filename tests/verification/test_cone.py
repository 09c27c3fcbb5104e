"""The burning slab: heat released and the heat of the flame, by both solvers."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from cases import FAINT, inert_material, rms_over_mean, run
from exact import deep_body
from terms import FAST, HEATED, SLOW, charring, specimen

from pyrofit.experiments import Cone
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_gasification, simulate_gasifications
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.reference.gasification import reference_gasification

BINS = Request(np.arange(2.5, 600.0, 5.0), 5.0)
POINTS = Request(np.arange(2.5, 600.0, 5.0))
REQUESTS = {"heat_release_rate": BINS, "mlr": BINS, "front_temperature": POINTS}
FIRST = {"reactant": "V", "products": {"M": 0.5}, **SLOW, **HEATED}
SECOND = {"reactant": "M", "products": {"C": 0.4}, **FAST, **HEATED}
FLAME = {"flux_W_m2": 2e4, "ignition_s": 60.0}
VALUES = {"F": 2e4, "begins": 60.0, "ends": 300.0, "hoc": 1e7}

Solver = Callable[..., Curves]


def kernel(*case: Any) -> Curves:
    return run(*case, Accuracy(cells=200, tolerance=1e-5, longest_step_s=5.0), VALUES)


def reference(experiment: Cone, material: Material, requests: Mapping[str, Request]) -> Curves:
    fine = Resolution(elements=200)
    return reference_gasification(experiment, material, VALUES, requests, fine)


both = pytest.mark.parametrize("solve", [kernel, reference])


def burning(flame: dict[str, Any] | None = None, **given: Any) -> Cone:
    """The charring specimen in a cone calorimeter."""
    inert = specimen(**given).model_dump() | {"kind": "cone", "flame": flame}
    return Cone.model_validate(inert)


def fuel(first: float | str = 2e7, second: float | str = 2e7) -> Material:
    """Two reactions, one after the other, whose gases burn."""
    return charring(
        {**FIRST, "heat_of_combustion_J_kg": first}, {**SECOND, "heat_of_combustion_J_kg": second}
    )


@both
def test_heat_release_is_the_heat_of_combustion_times_the_mass_loss_rate(solve: Solver) -> None:
    # Measured: 2e-14 of the peak, reference 5e-14.
    signals = solve(burning(), fuel(), REQUESTS).signals
    exact = 2e7 * signals["mlr"]
    assert signals["heat_release_rate"] == pytest.approx(exact, abs=1e-12 * exact.max())


@both
def test_all_heat_is_released_where_all_gas_burns(solve: Solver) -> None:
    # Gas per kg of V: 0.5 of the first reaction, 0.5 (1 - 0.4) of the second.
    end = {"heat_release_rate": Request(np.array([1000.0]), 2000.0)}
    experiment = burning(flux_kW_m2=60.0, back={})
    released = 2000.0 * solve(experiment, fuel(1e7, 3e7), end).signals["heat_release_rate"][0]
    exact = 1200.0 * 5e-3 * (0.5 * 1e7 + 0.3 * 3e7)
    # What is left at burn-out is 1e-5 of the sample. Measured: -1.1e-5, -7e-6.
    assert released == pytest.approx(exact, rel=3e-5)


@both
def test_gas_burns_from_ignition_to_flame_out(solve: Solver) -> None:
    # Without heat of the flame all else is as without it: only the share of each bin that burns.
    lit = solve(burning({"ignition_s": 61.0, "ends_s": 303.0}), fuel(), REQUESTS).signals
    shown, whole = lit["heat_release_rate"], 2e7 * lit["mlr"]
    inside = (BINS.time_s > 65.0) & (BINS.time_s < 300.0)
    assert shown[inside] == pytest.approx(whole[inside], rel=1e-9)
    assert np.all(shown[(BINS.time_s < 60.0) | (BINS.time_s > 305.0)] == 0.0)
    # The bins in which it ignites and goes out.
    for n, share in ((12, 0.8), (60, 0.6)):
        assert shown[n] == pytest.approx(share * whole[n], rel=0.05)


@both
def test_flame_adds_a_step_of_flux_to_an_inert_slab(solve: Solver) -> None:
    # Superposed: q from 0 on, F from ignition to flame-out. Measured: 0.06 K of 590 K, both.
    q, begins, ends = 1e4, 50.0, 120.0
    time = np.array([45.0, 70.0, 115.0, 150.0, 300.0])
    flame = {"flux_W_m2": 2e4 / FAINT, "ignition_s": begins, "ends_s": ends}
    front = {"flux_W_m2": q / FAINT, "h_W_m2K": 0.0}
    experiment = burning(flame, front=front, back={}, layers=({"thickness_m": 0.02},))
    requests = {"front_temperature": Request(time)}
    found = solve(experiment, inert_material(emissivity=FAINT), requests)

    def rise(flux: float, since: float) -> Any:
        passed = np.maximum(time - since, 0.0) + 1e-12
        return deep_body(flux, 0.2, 1200.0 * 1500.0, 0.0, passed)

    exact = 300.0 + rise(q, 0.0) + rise(2e4, begins) - rise(2e4, ends)
    assert found.signals["front_temperature"] == pytest.approx(exact, abs=0.1)


def test_both_solvers_agree_on_a_burning_slab() -> None:
    # Measured: heat release 1e-4, mass loss 7e-5 of their means, front 0.03 K.
    experiment = burning({"flux_W_m2": "F", "ignition_s": "begins", "ends_s": "ends"})
    ours, other = (solve(experiment, fuel("hoc", 3e7), REQUESTS) for solve in (kernel, reference))
    for name in ("heat_release_rate", "mlr"):
        assert rms_over_mean(ours.signals[name], other.signals[name]) <= 3e-4
    off = ours.signals["front_temperature"] - other.signals["front_temperature"]
    assert np.abs(off).max() <= 0.1
    assert other.energy_error <= 1e-5


def test_burning_keeps_mass_and_energy() -> None:
    experiment = burning({**FLAME, "ends_s": 400.0})
    curves = kernel(experiment, fuel(), {"front_temperature": Request(np.array([1500.0]))})
    assert curves.mass_error <= 1e-12
    assert curves.energy_error <= 1e-5


def test_flame_without_heat_and_gas_that_burns_change_nothing_else_bit_for_bit() -> None:
    names = ("mlr", "front_temperature")
    requests = {name: REQUESTS[name] for name in names}
    inert = run(specimen(), charring(FIRST, SECOND), requests, values={})
    plain = run(burning(), fuel(), requests, values={})
    with_heat = run(burning({"ignition_s": 0.0}), fuel(), REQUESTS, values={})
    for name in names:
        assert np.array_equal(inert.signals[name], plain.signals[name])
        assert np.array_equal(inert.signals[name], with_heat.signals[name])


TABLE = {"time_s": [0.0, 50.0, 50.0, 300.0], "value": [1e4, 2e4, 3e4, 4e4]}


def test_set_has_the_same_curves_alone_and_beside_others_that_ignite_at_other_times() -> None:
    flame = {"flux_W_m2": "F", "ignition_s": "begins", "ends_s": "ends"}
    experiment, rng = burning(flame, flux_kW_m2=TABLE), np.random.default_rng(5)
    many = {
        "begins": np.array([0.0, 20.0, 50.0, 300.0, 400.0, 900.0, 33.0, 77.0, 12.0]),
        "ends": np.array([500.0, 30.0, 300.0, 310.0, 100.0, 950.0, 50.0, 700.0, 400.0]),
        "F": 2e4 * rng.random(9),
        "hoc": 1e7 * (1.0 + rng.random(9)),
    }
    together = simulate_gasifications(experiment, fuel("hoc", 3e7), many, REQUESTS, sets=9)
    for s, curves in enumerate(together):
        values = {name: float(of[s]) for name, of in many.items()}
        alone = simulate_gasification(experiment, fuel("hoc", 3e7), values, REQUESTS)
        assert alone.status.finished
        for name, curve in curves.signals.items():
            assert np.array_equal(curve, alone.signals[name]), (s, name)


def test_temperature_before_a_step_of_the_flux_knows_nothing_of_it() -> None:
    # Points of a run without ignition are the same. Measured: 1e-5 K, reference 5e-5 K.
    time = np.array([57.0, 58.5, 59.9])
    before = kernel(burning(), fuel(), {"front_temperature": Request(time)})
    whole = kernel(burning(FLAME), fuel(), {"front_temperature": Request(np.append(time, 200.0))})
    found = whole.signals["front_temperature"]
    assert found[:-1] == pytest.approx(before.signals["front_temperature"], abs=1e-3)


def test_flame_that_ends_before_it_begins_is_refused() -> None:
    with pytest.raises(ValueError, match=r"ends_s 50 must be later than ignition_s 60"):
        burning({**FLAME, "ends_s": 50.0})
