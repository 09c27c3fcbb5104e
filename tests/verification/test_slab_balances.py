"""Balances of mass and energy

The paper's case (Table 4's RMSE set on 0.2 mm copper) at 10 to 100 kW/m², and variants of it:
char, insulated back, no foil, properties of temperature, absorption in depth. Mass closes to
round-off. The energy error is the imbalance of heat stored, used by reactions and exchanged,
relative to the heat that crossed the surfaces.
"""

from typing import Any, NamedTuple

import numpy as np
import pytest
from cases import (
    BEST,
    NAMES,
    inert_material,
    paper_experiment,
    paper_material,
    run,
    slab_experiment,
)
from evidence import Evidence
from sampling_limits import TABLE_6

from pyrofit.model.accuracy import Accuracy
from pyrofit.simulate import simulate_gasification
from pyrofit.solver.curves import Request

DURATION = {10: 6000.0, 25: 1700.0, 40: 1500.0, 60: 420.0, 100: 300.0}
HEAT = "imbalance / heat exchanged"
CHAR = BEST | {"rho_r": 300.0, "k_r": 0.12, "cp_r": 1500.0, "eps_r": 0.85}
WARM_K = [293.15, 393.15, 673.15]
TABLES: dict[str, Any] = {
    "conductivity_W_mK": {"temperature_K": WARM_K, "value": [0.2, 0.18, 0.12]},
    "specific_heat_J_kgK": {"temperature_K": WARM_K, "value": [1400.0, 1900.0, 2600.0]},
}
POWERS: dict[str, Any] = {
    "conductivity_W_mK": {"value": "k_a", "exponent": 0.7},
    "specific_heat_J_kgK": {"value": 1600.0, "exponent": 0.5},
}


class Case(NamedTuple):
    flux: int
    place: dict[str, Any]
    matter: dict[str, Any]
    values: dict[str, float]


CASES = {
    "10": Case(10, {}, {}, BEST),
    "25": Case(25, {}, {}, BEST),
    "60": Case(60, {}, {}, BEST),
    "100": Case(100, {}, {}, BEST),
    "char, 40": Case(40, {}, {"residue_yield": 0.2}, CHAR),
    "insulated, 25": Case(25, {"insulated": True}, {}, BEST),
    "insulated, 60": Case(60, {"insulated": True}, {}, BEST),
    "no foil, 25": Case(25, {"foil_m": None}, {}, BEST),
    "no foil, 60": Case(60, {"foil_m": None}, {}, BEST),
    "tables, 25": Case(25, {}, TABLES, BEST),
    "tables, 60": Case(60, {}, TABLES, BEST),
    "powers, 25": Case(25, {}, POWERS, BEST),
    "powers, 60": Case(60, {}, POWERS, BEST),
    "in depth, 25": Case(25, {}, {"absorption_1_m": 1e3}, BEST),
    "in depth, 60": Case(60, {}, {"absorption_1_m": 1e3}, BEST),
}


def errors(case: Case, accuracy: Accuracy | None = None) -> tuple[float, float]:
    """Mass and energy error; asking for the back temperature keeps the run going to the end."""
    time = np.arange(2.5, DURATION[case.flux], 5.0)
    requests = {"mlr": Request(time, 5.0), "back_temperature": Request(time)}
    material = paper_material(**case.matter)
    experiment = paper_experiment(case.flux, **case.place)
    curves = run(experiment, material, requests, accuracy, case.values)
    return curves.mass_error, curves.energy_error


@pytest.mark.parametrize("name", CASES)
def test_mass_and_energy_balance(evidence: Evidence, name: str) -> None:
    mass, energy = errors(CASES[name])
    title = f"{name} kW/m²"
    evidence.number(f"{title}: mass", mass, 1e-12, "imbalance / initial mass", "balance")
    evidence.number(f"{title}: energy", energy, 1e-5, HEAT, "balance")


@pytest.mark.parametrize("name", CASES)
def test_a_tolerance_of_a_thousandth_closes_the_energy_balance(
    evidence: Evidence, name: str
) -> None:
    _, energy = errors(CASES[name], Accuracy(tolerance=1e-3))
    title = f"{name} kW/m², tolerance 1e-3: energy"
    evidence.number(title, energy, 1e-5, HEAT, "balance")


def test_gas_in_the_bins_is_the_mass_that_is_lost(evidence: Evidence) -> None:
    bins = Request(np.arange(2.5, 1700.0, 5.0), 5.0)
    ends = Request(np.array([0.0, 1700.0]))
    curves = run(paper_experiment(25), paper_material(), {"mlr": bins, "mass": ends})
    first, last = curves.signals["mass"]
    assert first == pytest.approx(5.8e-3 * BEST["rho_a"], rel=1e-12)
    gap = abs(5.0 * curves.signals["mlr"].sum() - (first - last)) / first
    title = "25 kW/m²: sum of the mass loss rate in bins of 5 s"
    evidence.number(title, gap, 1e-12, "difference / initial mass", "mass lost")


def test_burnt_sample_leaves_its_residue(evidence: Evidence) -> None:
    ends = Request(np.array([420.0]))
    curves = run(paper_experiment(60), paper_material(), {"mass": ends})
    gap = abs(curves.signals["mass"][0] / (5.8e-3 * BEST["rho_a"]) - 1e-3)
    title = "60 kW/m²: residue of the burnt sample"
    source = "exact: 0.001; the run ends when 1e-5 of the initial mass is left to react"
    evidence.number(title, gap, 1e-5, "difference / initial mass", source)


def test_inert_slab_loses_no_mass() -> None:
    requests = {"mlr": Request(np.array([300.0])), "front_temperature": Request(np.array([600.0]))}
    experiment = slab_experiment(5.8e-3, {"flux_W_m2": 25e3, "h_W_m2K": 10.0})
    curves = run(experiment, inert_material(), requests, values={})
    assert curves.signals["mlr"][0] == 0.0
    assert curves.mass_error == 0.0


@pytest.mark.parametrize("flux", [25, 60])
def test_every_set_of_table_6_runs_and_balances(evidence: Evidence, flux: int) -> None:
    low, high = TABLE_6.T
    sets = low + (high - low) * np.random.default_rng(6).random((200, len(NAMES)))
    experiment, material = paper_experiment(flux), paper_material()
    time = np.arange(2.5, DURATION[flux], 5.0)
    requests = {"mlr": Request(time, 5.0), "back_temperature": Request(time)}
    mass, energy = [], []
    for row in sets:
        values = dict(zip(NAMES, row.tolist(), strict=True))
        curves = simulate_gasification(experiment, material, values, requests)
        assert curves.status.finished, values
        assert all(np.isfinite(signal).all() for signal in curves.signals.values()), values
        mass.append(curves.mass_error)
        energy.append(curves.energy_error)
    title = f"200 random sets within Table 6, {flux} kW/m²"
    evidence.number(f"{title}: mass", max(mass), 1e-12, "largest imbalance", "balance")
    evidence.number(f"{title}: energy", max(energy), 1e-4, "largest imbalance", "balance")
