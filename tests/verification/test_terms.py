"""The general terms: they vanish where they should, balance, and follow exact solutions."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from cases import FAINT, Curve, inert_material, placed, powder, rms_over_mean, run, slab_experiment
from scipy.integrate import quad
from scipy.optimize import brentq
from terms import (
    BASE,
    BEHIND,
    FAST,
    FOIL,
    HEATED,
    SIMPLE,
    TERMS,
    Term,
    charring,
    specimen,
)

from pyrofit.experiments import Gasification, Tga
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.model.material import Material
from pyrofit.model.properties import Changed
from pyrofit.simulate import simulate_tga
from pyrofit.solver.arrays import TABLE_TEMPERATURES_K, Status
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.lower_property import property_table
from pyrofit.solver.reference.gasification import reference_gasification
from pyrofit.solver.reference.tga import reference_tga

BINS = Request(np.arange(2.5, 600.0, 5.0), 5.0)
POINTS = Request(np.arange(5.0, 600.0, 5.0))
SIGNALS = ("front_temperature", "back_temperature", "thickness", "mass", "probe_0")
REQUESTS = {"mlr": BINS} | dict.fromkeys(SIGNALS, POINTS)


def simulated(term: Term, x: float) -> Curves:
    return run(term.experiment, term.material, REQUESTS, None, {"x": x}, (2e-3,))


@pytest.fixture(scope="module")
def base() -> Curves:
    return simulated(BASE, 0.0)


@pytest.mark.parametrize("name", TERMS)
def test_term_at_its_null_value_is_the_base_model_bit_for_bit(name: str, base: Curves) -> None:
    null = simulated(TERMS[name], TERMS[name].null)
    for signal, curve in base.signals.items():
        assert np.array_equal(null.signals[signal], curve), signal
    assert (null.steps, null.energy_error) == (base.steps, base.energy_error)


@pytest.mark.parametrize("name", TERMS)
def test_term_away_from_its_null_value_changes_the_mass_loss_rate(name: str, base: Curves) -> None:
    # Measured, rms over mean: 0.023 (back_gas_rise) to 0.50 (absorption_length).
    away = simulated(TERMS[name], TERMS[name].away)
    assert rms_over_mean(away.signals["mlr"], base.signals["mlr"]) >= 0.02


@pytest.mark.parametrize("name", TERMS)
def test_term_keeps_mass_and_energy(name: str) -> None:
    # Measured over 1500 s: mass 2e-15; energy 1.3e-6 to 2.0e-6.
    term = TERMS[name]
    ends = Request(np.array([1500.0]))
    requests = {"mlr": ends, "back_temperature": ends}
    curves = run(term.experiment, term.material, requests, None, {"x": term.away})
    assert curves.mass_error <= 1e-12
    assert curves.energy_error <= 1e-5


# Exact solutions, which both solvers follow

Solver = Callable[..., Curves]


def _kernel(*case: Any, probes_m: tuple[float, ...] = ()) -> Curves:
    fine = Accuracy(cells=200, tolerance=1e-5, longest_step_s=5.0)
    return run(*case, fine, {}, probes_m)


def _reference(
    experiment: Gasification,
    material: Material,
    requests: Mapping[str, Request],
    probes_m: tuple[float, ...] = (),
) -> Curves:
    fine = Resolution(elements=200)
    asked = placed(requests, probes_m)
    curves = reference_gasification(experiment, material, {}, asked, fine)
    assert curves.status.finished
    return curves


both = pytest.mark.parametrize("solve", [_kernel, _reference])
RHO, K, C, T0, DEPTH = 1200.0, 0.2, 1500.0, 293.15, 5e-3
FOIL_CAPACITY = 679.44
"""That of ``FOIL`` [J/(m2 K)]."""
THIN = 2e-4
"""Thickness [m] of a slab that has one temperature."""


def temperatures(solve: Solver, experiment: Gasification, material: Material, at: float) -> Curve:
    """Temperatures [K] of front, middle, just inside the back, and back (foil) at a time [s]."""
    names = ("front_temperature", "probe_0", "probe_1", "back_temperature")
    requests = {name: Request(np.array([at])) for name in names}
    probes = 0.5 * DEPTH, (1.0 - 1e-9) * DEPTH
    signals = solve(experiment, material, requests, probes_m=probes).signals
    return np.array([signals[name][0] for name in names])


@both
def test_contact_is_a_resistance_between_sample_and_foil(solve: Solver) -> None:
    # Steady heat through h, d/k, R, h in series. Measured: kernel 5e-8 K, reference 4e-6 K.
    hot, cold, h, h_back, contact = 600.0, 300.0, 50.0, 20.0, 0.02
    experiment = slab_experiment(
        DEPTH,
        {"h_W_m2K": h, "gas_temperature_K": hot},
        {"h_W_m2K": h_back, "gas_temperature_K": cold},
        foil={**FOIL, "contact_m2K_W": contact},
    )
    found = temperatures(solve, experiment, inert_material(emissivity=0.0), 2e4)
    q = (hot - cold) / (1.0 / h + DEPTH / K + contact + 1.0 / h_back)
    front = hot - q / h
    exact = [front, front - 0.5 * q * DEPTH / K, front - q * DEPTH / K, cold + q / h_back]
    assert found == pytest.approx(exact, abs=1e-5)


@both
def test_edge_makes_a_fin_of_the_sample(solve: Solver) -> None:
    # Steady: T - T_gas = a cosh(m (L - x)), m^2 = h P/(A k). Measured: 2.7e-4 K, 1.8e-4 K.
    hot, cold, h, exchange = 600.0, 300.0, 50.0, 20.0 * 400.0
    edge = {"h_W_m2K": 20.0, "perimeter_per_area_1_m": 400.0, "gas_temperature_K": cold}
    front = {"h_W_m2K": h, "gas_temperature_K": hot}
    experiment = slab_experiment(DEPTH, front, edge=edge)
    found = temperatures(solve, experiment, inert_material(emissivity=0.0), 2e4)
    m = np.sqrt(exchange / K)
    a = h * (hot - cold) / (K * m * np.sinh(m * DEPTH) + h * np.cosh(m * DEPTH))
    exact = cold + a * np.cosh(m * (DEPTH - np.array([0.0, 0.5, 1.0, 1.0]) * DEPTH))
    assert found == pytest.approx(exact, abs=4e-4)


@both
def test_thin_slab_follows_gas_that_warms_up(solve: Solver) -> None:
    # C dT/dt = h (T_gas + D (1 - exp(-t/tau)) - T), D = 100 K. Measured: 3.3e-3 K, 2e-4 K.
    rise, tau, h = 100.0, 40.0, 30.0
    side = {"h_W_m2K": h, "gas_rise_K": rise, "gas_rise_time_s": tau}
    time = np.array([5.0, 20.0, 40.0, 80.0, 200.0])
    requests = {"back_temperature": Request(time)}
    matter = inert_material(emissivity=0.0, conductivity=50.0)
    found = solve(slab_experiment(THIN, side, side), matter, requests)
    decay = 2.0 * h / (RHO * C * THIN)
    lagging = (decay * np.exp(-time / tau) - np.exp(-decay * time) / tau) / (decay - 1.0 / tau)
    exact = T0 + rise * (1.0 - lagging)
    assert found.signals["back_temperature"] == pytest.approx(exact, abs=5e-3)


TAU, DRIFT = 30.0, 2e-3
HEATERS: dict[str, tuple[dict[str, float], Callable[[float], float]]] = {
    "is_multiplied": ({"flux_factor": 1.1}, lambda t: 1.1),
    "rises": ({"rise_time_s": TAU}, lambda t: 1.0 - np.exp(-t / TAU)),
    "drifts": ({"drift_1_s": DRIFT}, lambda t: 1.0 + DRIFT * t),
    "drifts_to_zero": ({"drift_1_s": -0.01}, lambda t: max(1.0 - 0.01 * t, 0.0)),
    "drifts_for_a_while": (
        {"drift_1_s": DRIFT, "drift_time_s": TAU},
        lambda t: 1.0 + DRIFT * TAU * (1.0 - np.exp(-t / TAU)),
    ),
}


@both
@pytest.mark.parametrize("name", HEATERS)
def test_thin_slab_keeps_the_heat_of_a_changing_flux(name: str, solve: Solver) -> None:
    # Measured: kernel at most 5.4e-3 K (rises), reference 8e-4 K, of 42 K to 144 K.
    change, share = HEATERS[name]
    flux, time = 300.0, np.array([10.0, 50.0, 150.0])
    experiment = slab_experiment(THIN, {"flux_W_m2": flux / FAINT, **change})
    matter = inert_material(emissivity=FAINT, conductivity=50.0)
    found = solve(experiment, matter, {"back_temperature": Request(time)})
    heat = [flux * quad(share, 0.0, t, points=[100.0])[0] for t in time]
    exact = T0 + np.array(heat) / (RHO * C * THIN)
    assert found.signals["back_temperature"] == pytest.approx(exact, abs=8e-3)


def evened_out(solve: Solver, experiment: Gasification, material: Material) -> float:
    """Temperature [K] of an insulated slab long after its heating."""
    curves = solve(experiment, material, {"back_temperature": Request(np.array([3000.0]))})
    return float(curves.signals["back_temperature"][0])


PULSE = {"time_s": [0.0, 60.0, 60.0], "value": [2e4 / FAINT, 2e4 / FAINT, 0.0]}
HEAT = 2e4 * 60.0
CHANGES = {
    "slope": {"slope_1_K": 2e-3, "reference_temperature_K": 300.0},
    "step": {"step": 900.0, "step_temperature_K": 350.0},
    "peak": {"peak_area": 5e4, "peak_temperature_K": 340.0, "peak_width_K": 6.0},
}


@both
@pytest.mark.parametrize("name", CHANGES)
def test_slope_step_and_peak_of_the_specific_heat_take_their_heat(name: str, solve: Solver) -> None:
    # Measured: kernel 3e-4, 4e-4, 23e-4 K; reference 1e-4, 2e-4, 6e-4 K.
    enthalpy = {
        "slope": lambda T: 1e-3 * C * ((T - 300.0) ** 2 - (T0 - 300.0) ** 2),
        "step": lambda T: 7200.0 * np.diff(np.logaddexp(0.0, (np.array([T0, T]) - 350.0) / 8.0))[0],
        "peak": lambda T: 5e4,
    }[name]
    exact = brentq(lambda T: RHO * DEPTH * (C * (T - T0) + enthalpy(T)) - HEAT, T0, 500.0)
    matter = inert_material(emissivity=FAINT, specific_heat={"of": C, **CHANGES[name]})
    found = evened_out(solve, slab_experiment(DEPTH, {"flux_W_m2": PULSE}), matter)
    assert found == pytest.approx(exact, abs=3e-3)


@both
@pytest.mark.parametrize("foil", [FOIL, None], ids=["foil", "no foil"])
@pytest.mark.parametrize("to", ["foil", "back", "lost"])
def test_radiation_that_passes_heats_the_back_or_is_lost(
    to: str, foil: dict[str, float] | None, solve: Solver
) -> None:
    # kappa d = 0.5. Measured: 4e-4 K of 124 K and 1.1e-4 K of 49 K, both solvers.
    absorbed = 1.0 if to == "back" or (to == "foil" and foil) else 1.0 - np.exp(-0.5)
    experiment = slab_experiment(DEPTH, {"flux_W_m2": PULSE}, foil=foil, transmitted=to)
    matter = inert_material(emissivity=FAINT, absorption=100.0)
    exact = T0 + HEAT * absorbed / (RHO * C * DEPTH + (FOIL_CAPACITY if foil else 0.0))
    assert evened_out(solve, experiment, matter) == pytest.approx(exact, abs=6e-4)


@both
def test_surface_share_adds_up_surface_and_depth(solve: Solver) -> None:
    # Without losses the rise is linear in what is absorbed. Measured: 5e-10 K of 45 K.
    matter = inert_material(emissivity=FAINT, absorption=1000.0)
    opaque = inert_material(emissivity=FAINT)
    front = {"flux_W_m2": 1e4 / FAINT}
    found = temperatures(solve, slab_experiment(DEPTH, front, surface_share=0.3), matter, 40.0)
    surface = temperatures(solve, slab_experiment(DEPTH, front), opaque, 40.0)
    depth = temperatures(solve, slab_experiment(DEPTH, front), matter, 40.0)
    assert found == pytest.approx(0.3 * surface + 0.7 * depth, abs=1e-4)


@both
def test_absorption_factor_makes_a_hot_slab_absorb_more(solve: Solver) -> None:
    # kappa d = 0.5 below 250 K, twice of that above; the slab begins at 293 K. Measured: 4e-4 K.
    factor = {"of": 1.0, "step": 1.0, "step_temperature_K": 250.0, "step_width_K": 0.5}
    matter = inert_material(emissivity=FAINT, absorption=100.0)
    component = matter.components["solid"]
    given = component.model_dump() | {"absorption_factor": factor}
    matter = Material.model_validate(matter.model_dump() | {"components": {"solid": given}})
    experiment = slab_experiment(DEPTH, {"flux_W_m2": PULSE}, transmitted="lost")
    exact = T0 + HEAT * (1.0 - np.exp(-1.0)) / (RHO * C * DEPTH)
    assert evened_out(solve, experiment, matter) == pytest.approx(exact, abs=1e-3)


CONDUCTIVITIES: dict[str, tuple[dict[str, float], Callable[[float], float]]] = {
    "bend": (
        {"scale": 2.0, "bend": -1e-3, "step_temperature_K": 400.0, "step_width_K": 10.0},
        lambda T: 1.0 - 2e-3 * 10.0 * np.logaddexp(0.0, (T - 400.0) / 10.0),
    ),
    "thinning": (
        {"scale": 2.0, "thinning": 0.5, "step_temperature_K": 400.0, "step_width_K": 10.0},
        lambda T: 1.0 / (1.0 + 1.0 / (1.0 + np.exp(-(T - 400.0) / 10.0))),
    ),
}


@both
@pytest.mark.parametrize("name", CONDUCTIVITIES)
def test_bend_and_thinning_of_the_conductivity_set_the_steady_temperatures(
    name: str, solve: Solver
) -> None:
    # Kirchhoff: d q = int k dT between the faces, and h q = rise to the gas on both sides.
    change, relative = CONDUCTIVITIES[name]
    hot, cold, h = 700.0, 300.0, 200.0
    matter = inert_material(emissivity=0.0, conductivity={"of": K, **change})
    sides = ({"h_W_m2K": h, "gas_temperature_K": T} for T in (hot, cold))
    found = temperatures(solve, slab_experiment(DEPTH, *sides), matter, 2e4)

    def across(T_from: float, T_to: float) -> float:
        return K * quad(relative, T_from, T_to, points=[400.0], limit=200)[0]

    q = brentq(lambda q: across(cold + q / h, hot - q / h) - q * DEPTH, 0.0, 2e4)
    front, back = hot - q / h, cold + q / h
    middle = brentq(lambda T: across(T, front) - 0.5 * q * DEPTH, back, front)
    assert found == pytest.approx([front, middle, back, back], abs=0.05)


@both
def test_gas_takes_heat_from_the_layers_that_it_passes(solve: Solver) -> None:
    # A rate that no temperature changes and that leaves the mass: G = g (1 - z/L). Steady,
    # k T'' + c_g G T' = 0, so that T' = B exp(-P (z/L - (z/L)^2/2)), P = c_g g L/k.
    A, P, hot, cold, h = 1e-10, 1.5, 700.0, 300.0, 60.0
    solid = {"density_kg_m3": RHO, "conductivity_W_mK": K, "specific_heat_J_kgK": C}
    matter = Material.model_validate(
        {
            "components": {"solid": {**solid, "emissivity": 0.0}},
            "reactions": {"0": {"reactant": "solid", "A_1_s": A, "E_J_mol": 0.0}},
            "composition": {"solid": 1.0},
        }
    )
    c_g = P * K / (A * RHO * DEPTH**2)
    sides = ({"h_W_m2K": h, "gas_temperature_K": T} for T in (hot, cold))
    experiment = slab_experiment(DEPTH, *sides, gas_specific_heat_J_kgK=c_g)
    found = temperatures(solve, experiment, matter, 2e4)

    def fall(s: float) -> float:
        return quad(lambda u: np.exp(-P * (u - 0.5 * u * u)), 0.0, s)[0]

    # K B/L = flux at the front, times exp(-P/2) = that at the back.
    B = (hot - cold) / (fall(1.0) + K / (DEPTH * h) * (1.0 + np.exp(-0.5 * P)))
    front = hot - B * K / (DEPTH * h)
    exact = [front, front - B * fall(0.5), front - B * fall(1.0), front - B * fall(1.0)]
    assert found == pytest.approx(exact, abs=5e-3)


# Terms that another description says as well


def same(one: tuple[Gasification, Material], other: tuple[Gasification, Material]) -> bool:
    requests = {"mlr": BINS, "front_temperature": POINTS, "back_temperature": POINTS}
    a, b = (run(*case, requests, values={}).signals for case in (one, other))
    return all(np.array_equal(a[name], b[name]) for name in requests)


def test_half_the_loss_is_half_of_all_coefficients_of_the_back() -> None:
    whole = {**BEHIND, "h_cube_root_W_m2K43": 1.2}
    half = whole | {name: 0.5 * whole[name] for name in ("h_W_m2K", "emissivity")}
    half["h_cube_root_W_m2K43"] = 0.6
    halved = specimen(back={**whole, "loss_factor": 0.5})
    assert same((halved, charring()), (specimen(back=half), charring()))


def test_thickness_factor_multiplies_every_layer() -> None:
    layers = {"thickness_m": 1e-3, "composition": {"V": 0.5, "C": 0.5}}, {"thickness_m": 4e-3}
    double = tuple(
        {**layer, "thickness_m": 2.0 * float(str(layer["thickness_m"]))} for layer in layers
    )
    thick = specimen(layers=layers, thickness_factor=2.0)
    assert same((thick, charring()), (specimen(layers=double), charring()))


@pytest.mark.parametrize(
    ("factor", "keys"),
    [
        ("density_factor", ("density_kg_m3", "conductivity_W_mK")),
        ("conductivity_factor", ("conductivity_W_mK",)),
    ],
)
def test_factor_multiplies_properties_of_the_material(factor: str, keys: tuple[str, ...]) -> None:
    twice = charring().model_dump(exclude_unset=True)
    for component in twice["components"].values():
        for key in keys:
            component[key] *= 2.0
    given = specimen(foil=FOIL, **{factor: 2.0})
    assert same((given, charring()), (specimen(foil=FOIL), Material.model_validate(twice)))


def test_absorption_length_stands_for_the_coefficient_of_every_component() -> None:
    clear = {"absorption_1_m": 2000.0 / 3.0}
    coefficients = charring(kappa=2000.0, char=clear | {"absorption_1_m": 2000.0})
    given = specimen(absorption_length_m=1.0 / 2048.0)
    plain = charring(kappa=2048.0, char={"absorption_1_m": 2048.0})
    assert same((given, coefficients), (specimen(), plain))
    assert same((given, charring()), (specimen(), plain))


def test_emissivity_stays_within_0_and_1() -> None:
    # A change of 1e4 makes the surface black or white as soon as mass is lost. Measured: 5e-13 K.
    black = charring(virgin={"emissivity": 1.0}, char={"emissivity": 1.0})
    white = charring(virgin={"emissivity": 0.0}, char={"emissivity": 0.0})
    requests = {"front_temperature": Request(np.array([300.0, 590.0]))}
    for change, matter in ((1e4, black), (-1e4, white)):
        changed = run(specimen(emissivity_change=change), matter, requests, values={})
        limit = run(specimen(), matter, requests, values={})
        hot = limit.signals["front_temperature"]
        assert changed.signals["front_temperature"] == pytest.approx(hot, abs=1e-9)


@both
def test_expanded_slab_is_a_thicker_one_of_less_density(solve: Solver) -> None:
    # The edge sees the thickness too. Measured: 0.
    edge = {"h_W_m2K": 20.0, "perimeter_per_area_1_m": 40.0}
    names = ("front_temperature", "back_temperature", "thickness")
    requests = {name: Request(np.array([30.0, 100.0, 300.0])) for name in names}
    matter = inert_material(density=RHO)
    component = matter.components["solid"].model_copy(update={"expansion": 2.0})
    expanded = matter.model_copy(update={"components": {"solid": component}})
    front = {"flux_W_m2": 2e4, "h_W_m2K": 10.0}
    ours = solve(slab_experiment(DEPTH, front, edge=edge), expanded, requests)
    other = slab_experiment(2.0 * DEPTH, front, edge=edge, emissivity_depth=2e-5)
    thick = solve(other, inert_material(density=0.5 * RHO), requests)
    for name in names:
        assert ours.signals[name] == pytest.approx(thick.signals[name], rel=1e-13)


def test_adhesive_is_a_last_layer_of_its_component() -> None:
    # Only its cells differ: those of the sample stay as many as without it. Measured: 6.5e-5.
    glue = {"thickness_m": 1e-3, "component": "M"}
    layers = {"thickness_m": 4e-3}, {"thickness_m": 1e-3, "composition": {"M": 1.0}}
    matter = charring(SIMPLE, {"reactant": "M", **FAST, **HEATED})
    requests, fine = {"mlr": BINS, "mass": POINTS}, Accuracy(cells=400, tolerance=1e-5)
    one, other = (
        run(experiment, matter, requests, fine, {}).signals
        for experiment in (
            specimen(layers=({"thickness_m": 4e-3},), adhesive=glue, foil=FOIL),
            specimen(layers=layers, foil=FOIL),
        )
    )
    assert rms_over_mean(one["mlr"], other["mlr"]) <= 1e-4
    assert one["mass"] == pytest.approx(other["mass"], rel=1e-4)
    assert one["mass"][0] == pytest.approx(4e-3 * 1200.0 + 1e-3 * 900.0, rel=1e-3)


@pytest.mark.parametrize("thickness", [0.0, "x"])
def test_adhesive_without_thickness_is_none_bit_for_bit(
    thickness: float | str, base: Curves
) -> None:
    glue = {"thickness_m": thickness, "component": "M"}
    signals = {n: {"file": "synthetic"} for n in ("mlr", "back_temperature")}
    experiment = specimen(foil=FOIL, adhesive=glue, signals=signals)
    none = run(experiment, charring(), REQUESTS, None, {"x": 0.0}, (2e-3,))
    for signal, curve in base.signals.items():
        assert np.array_equal(none.signals[signal], curve), signal


# What the apparatus does, and TGA


def test_record_that_is_late_shows_earlier_values_and_an_offset_lifts_them() -> None:
    late = TERMS["delay"], {"mlr": Request(BINS.time_s + 7.0, 5.0)}
    lifted = TERMS["offset"], {"mlr": BINS}
    plain = run(BASE.experiment, BASE.material, {"mlr": BINS}, values={}).signals["mlr"]
    for (term, requests), offset in ((late, 0.0), (lifted, 1e-3)):
        curves = run(term.experiment, term.material, requests, values={"x": term.away})
        assert np.array_equal(curves.signals["mlr"], plain + offset)


def test_record_that_is_late_begins_with_nothing() -> None:
    signal = {"file": "synthetic", "delay_s": 100.0}
    early = {"mlr": Request(np.array([2.5, 50.0, 97.5]), 5.0)}
    experiment = specimen(signals={"mlr": signal})
    for curves in (
        run(experiment, charring(), early, values={}),
        reference_gasification(experiment, charring(), {}, early),
    ):
        assert curves.signals["mlr"].tolist() == [0.0, 0.0, 0.0]


POWDER = powder("B", {"B": 1.0}, {"reactant": "B", "A_1_s": 1e11, "E_J_mol": 1.6e5})


@pytest.mark.parametrize("solve", [simulate_tga, reference_tga])
def test_sample_is_colder_by_rate_times_lag_and_hotter_by_the_offset(
    solve: Callable[..., Curves],
) -> None:
    # 12 s at 10 K/min are 2 K; then k changes by the factor of 2 K.
    time = np.linspace(0.0, 3300.0, 300)
    program = 300.0 + time / 6.0

    def heated(temperature: Curve, **off: float) -> Curve:
        experiment = Tga.model_validate(
            {
                "kind": "tga",
                "heating_rate_K_min": 10.0,
                **off,
                "signals": {"mass_fraction": {"file": "synthetic"}},
            }
        )
        curves = solve(experiment, POWDER, {}, Request(time, temperature_K=temperature))
        assert curves.status is Status.OK
        return curves.signals["mass_fraction"]

    lagging = heated(program, lag_s=12.0)
    assert np.array_equal(lagging, heated(program - 2.0))
    assert np.abs(lagging - heated(program)).max() >= 0.02
    assert np.array_equal(heated(program, temperature_offset_K=2.0), heated(program + 2.0))
    both = heated(program, temperature_offset_K=2.0, lag_s=12.0)
    assert np.array_equal(both, heated(program))


def test_changed_property_keeps_a_hundredth() -> None:
    changed = Changed.model_validate({"of": 0.2, "step": -5.0, "step_temperature_K": 600.0})
    table = property_table(changed, {})[:, 0]
    assert table[0] == pytest.approx(0.2, rel=1e-12)
    assert table[-1] == 0.01 * 0.2


def test_peak_has_its_area_in_the_table_even_at_its_least_width() -> None:
    # Measured: 6.5e-6.
    given = {"of": 1000.0, "peak_area": 1e5, "peak_temperature_K": 452.5, "peak_width_K": 4.0}
    peak = property_table(Changed.model_validate(given), {}) - 1000.0
    assert np.trapezoid(peak[:, 0], TABLE_TEMPERATURES_K) == pytest.approx(1e5, rel=1e-5)


def test_narrow_step_does_not_overflow() -> None:
    given = {"of": 1000.0, "step": 100.0, "step_temperature_K": 400.0, "step_width_K": 0.01}
    table = property_table(Changed.model_validate(given), {})[:, 0]
    assert sorted(set(table.tolist())) == [1000.0, 1050.0, 1100.0]
