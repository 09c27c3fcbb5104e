"""A parameter set has the same curves to the last bit alone and beside others."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
import yaml
from cases import Probes, inert_material, placed
from terms import BEHIND, FAST, FOIL, HEATED, SIMPLE, SLOW, TERMS, charring, specimen

from pyrofit.config import as_study
from pyrofit.experiments import Gasification, Tga
from pyrofit.model.material import Material
from pyrofit.model.signal import Follows
from pyrofit.simulate import (
    Accuracy,
    simulate_gasification,
    simulate_gasifications,
    simulate_tga,
    simulate_tgas,
)
from pyrofit.solver.arrays import FloatArray, Status
from pyrofit.solver.curves import Curves, Place, Request
from pyrofit.solver.run import FEW, LANES

PAPER = Path(__file__).parents[2] / "config" / "paper.yaml"
ENDS_S = {"capa_25": 1400.0, "capa_60": 400.0}
NAMES = ("front_temperature", "back_temperature", "thickness", "mass")
MANY = 2 * LANES + FEW
"""Two groups of full lanes, and sets that are run one by one."""

Values = Mapping[str, float | FloatArray]


def requests(end_s: float = 400.0) -> dict[str, Request]:
    points = Request(np.arange(5.0, end_s, 5.0))
    return {"mlr": Request(points.time_s - 2.5, 5.0)} | dict.fromkeys(NAMES, points)


def of_set(values: Values, s: int) -> dict[str, float]:
    return {n: float(v[s]) if isinstance(v, np.ndarray) else v for n, v in values.items()}


def bits(curves: Curves) -> dict[str, object]:
    """Return all of a run in a form that is equal if every bit is."""
    return {
        "status": curves.status,
        "steps": curves.steps,
        "cells": curves.cells,
        "energy error": curves.energy_error.hex(),
        "mass error": curves.mass_error.hex(),
    } | {name: curve.tobytes() for name, curve in curves.signals.items()}


def assert_same(found: list[Curves], alone: list[Curves]) -> None:
    differ = {}
    for s, (one, other) in enumerate(zip(found, alone, strict=True)):
        ours, theirs = bits(one), bits(other)
        assert ours.keys() == theirs.keys(), f"set {s}"
        differ[s] = [name for name in ours if ours[name] != theirs[name]]
    assert {s: names for s, names in differ.items() if names} == {}


def checked(
    experiment: Gasification,
    material: Material,
    values: Values,
    sets: int,
    asked: Mapping[str, Request] | None = None,
    accuracy: Accuracy | None = None,
    probes_m: Probes = (),
) -> list[Curves]:
    """Return the curves of sets side by side, which are those of each alone, bit for bit."""
    case = placed(asked or requests(), probes_m), accuracy
    found = simulate_gasifications(experiment, material, values, *case, sets)
    alone = [
        simulate_gasification(experiment, material, of_set(values, s), *case) for s in range(sets)
    ]
    assert_same(found, alone)
    return found


def all_differ(curves: list[Curves]) -> bool:
    """Tell whether no two runs are the same: the test could fail."""
    return len({str(bits(c)) for c in curves}) == len(curves)


# Random sets


@cache
def box(name: str) -> tuple[Gasification, Material, dict[str, FloatArray], list[Curves]]:
    """Random sets within the limits of the paper's study, and the curves of each alone."""
    study = as_study(yaml.safe_load(PAPER.read_text(encoding="utf-8")), "paper.yaml")
    draw = np.random.default_rng(60)
    values = {
        n: p.factor * draw.uniform(p.lower, p.upper, MANY) for n, p in study.parameters.items()
    }
    experiment = study.experiments[name]
    assert isinstance(experiment, Gasification)
    alone = [
        simulate_gasification(experiment, study.material, of_set(values, s), requests(ENDS_S[name]))
        for s in range(MANY)
    ]
    return experiment, study.material, values, alone


def some(name: str, order: Any, threads: int = 1) -> list[Curves]:
    """Run some of the sets side by side."""
    experiment, material, values, _ = box(name)
    chosen = {n: v[order] for n, v in values.items()}
    asked = requests(ENDS_S[name])
    return simulate_gasifications(
        experiment, material, chosen, asked, sets=len(order), threads=threads
    )


both = pytest.mark.parametrize("name", ENDS_S)


def test_random_sets_cover_what_can_differ() -> None:
    alone = box("capa_25")[-1] + box("capa_60")[-1]
    assert all_differ(alone)
    assert len({c.cells for c in alone}) >= 3
    assert len({c.steps for c in alone}) >= MANY
    assert {c.status for c in alone} == {Status.OK, Status.UNBURNT}


@both
@pytest.mark.parametrize("threads", [1, 2])
def test_set_is_the_same_alone_and_among_many(name: str, threads: int) -> None:
    assert_same(some(name, np.arange(MANY), threads), box(name)[-1])


@both
@pytest.mark.parametrize("threads", [1, 2])
def test_order_of_the_sets_does_not_matter(name: str, threads: int) -> None:
    alone = box(name)[-1]
    for order in (np.arange(MANY)[::-1], np.random.default_rng(7).permutation(MANY)):
        assert_same(some(name, order, threads), [alone[s] for s in order])


@pytest.mark.parametrize(("spread", "groups"), [(1.0, 1), (20.0, 0)])
def test_sets_whose_cells_differ_much_run_one_by_one(
    spread: float, groups: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pyrofit.solver.kernels import slab

    calls: list[Any] = []
    together = slab.slabs
    monkeypatch.setattr(slab, "slabs", lambda *given: calls.append(given) or together(*given))
    experiment, material, values, _ = box("capa_60")
    alike: dict[str, float | FloatArray] = {n: np.full(LANES, v[0]) for n, v in values.items()}
    alike["k_a"] = 0.2 / np.array([*[1.0] * (LANES - 1), spread])
    found = checked(experiment, material, alike, LANES)
    assert found[-1].cells >= 0.5 * spread * found[0].cells
    assert len(calls) == groups


@both
def test_set_is_the_same_in_every_lane(name: str) -> None:
    # The sort by cells keeps the order of equals: each set comes to every lane among its like.
    alone = box(name)[-1]
    for turn in range(LANES):
        order = np.roll(np.arange(LANES), turn)
        assert_same(some(name, order), [alone[s] for s in order])
    for s in range(3):
        assert_same(some(name, np.full(LANES, s)), LANES * [alone[s]])


@both
def test_number_of_sets_does_not_matter(name: str) -> None:
    alone = box(name)[-1]
    for sets in range(1, LANES + FEW + 2):
        order = np.arange(MANY - sets, MANY)
        assert_same(some(name, order), [alone[s] for s in order])


# Every term


@pytest.mark.parametrize("name", TERMS)
def test_term_acts_in_its_lane_alone(name: str) -> None:
    term = TERMS[name]
    share = np.array([0.0, 1.0, 0.0, 0.5, 0.25, 0.0, 1.0, 0.75])
    x = term.null + share * (term.away - term.null)
    found = checked(term.experiment, term.material, {"x": x}, LANES)
    assert_same(found[:1] + found[1:2], [found[5], found[6]])
    assert all_differ([found[s] for s in (0, 1, 3, 4, 7)])


def test_delay_offset_and_spread_belong_to_their_set() -> None:
    signal = {"file": "synthetic", "delay_s": "t", "offset": "up"}
    experiment = specimen(
        front={"spread": "s"}, signals={"mlr": signal, "back_temperature": signal}
    )
    values = {
        "t": np.array([0.0, 7.0, 0.0, -4.0, 500.0, 0.0, 2.5, 0.0]),
        "up": np.array([0.0, 1e-3, 0.0, 0.0, 0.0, -1e-3, 0.0, 0.0]),
        "s": np.array([0.0, 0.2, 0.2, 0.0, 0.1, 0.0, 0.0, 0.05]),
    }
    assert len({str(bits(c)) for c in checked(experiment, charring(), values, LANES)}) == LANES


# The grid, and how runs end

THICK = {"size": np.array([2e-3, 30e-3, 5e-3, 12e-3, 30e-3, 2e-3, 8e-3, 50e-3])}
SIZED = ({"thickness_m": "size"},)
SHORT = requests(150.0)
BURNING = charring({**SIMPLE, "products": {"C": 1e-3}})
"""A thousandth is left over: burnt cells are thin, and become skin."""


def test_sets_have_their_own_number_of_cells() -> None:
    found = checked(specimen(80.0, layers=SIZED), charring(), THICK, LANES)
    assert len({c.cells for c in found}) >= 4


def test_sets_of_several_layers_have_their_own_number_of_cells() -> None:
    layers = ({"thickness_m": 1e-3, "composition": {"V": 0.5, "C": 0.5}}, *SIZED)
    found = checked(specimen(80.0, layers=layers), charring(), THICK, LANES)
    assert len({c.cells for c in found}) >= 4


def test_cells_leave_the_grid_in_their_own_lane() -> None:
    values = THICK | {"q": np.array([0.0, 90e3, 60e3, 30e3, 70e3, 80e3, 90e3, 50e3])}
    experiment = specimen({"time_s": [0.0], "value": ["q"]}, layers=SIZED, foil=FOIL)
    found = checked(experiment, BURNING, values, LANES, requests(900.0))
    assert {c.status for c in found} == {Status.OK, Status.UNBURNT}
    left = [c.signals["thickness"][-1] / size for c, size in zip(found, THICK["size"], strict=True)]
    assert min(left) < 0.01
    assert max(left) > 0.9


@pytest.mark.parametrize("names", [("mlr",), ("mlr", "back_temperature")])
def test_burnt_out_and_unburnt_sets_run_side_by_side(names: tuple[str, ...]) -> None:
    # A run that is asked for its mass loss rate alone ends when it has burnt out.
    experiment = specimen({"time_s": [0.0], "value": ["q"]})
    values = {"q": np.array([10e3, 80e3, 30e3, 100e3, 0.0, 50e3, 60e3, 20e3])}
    asked = {name: requests(500.0)[name] for name in names}
    found = checked(experiment, BURNING, values, LANES, asked)
    assert {c.status for c in found} == {Status.OK, Status.UNBURNT}
    assert all_differ(found)


def test_set_that_diverges_leaves_its_neighbours_alone() -> None:
    experiment = specimen({"time_s": [0.0, 40.0, 40.0], "value": [2e4, 2e4, "q"]})
    values = {"q": np.array([4e4, 1e10, 6e4, 2e4, 1e12, 5e4, 3e4, 1e9])}
    found = checked(experiment, charring(), values, LANES)
    failed = [c.status is Status.DIVERGED for c in found]
    assert failed == [False, True, False, False, True, False, False, True]
    assert all(c.signals == {} for c, bad in zip(found, failed, strict=True) if bad)
    assert all(c.status.finished for c, bad in zip(found, failed, strict=True) if not bad)


def test_set_without_a_number_leaves_its_neighbours_alone() -> None:
    material = charring(virgin={"conductivity_W_mK": "k"})
    values = {"k": np.array([0.2, np.nan, 0.1, 0.3, 0.25, 0.15, np.nan, 0.4])}
    found = checked(specimen(), material, values, LANES, accuracy=Accuracy(cells=60))
    failed = [c.status is Status.NON_FINITE for c in found]
    assert failed == np.isnan(values["k"]).tolist()


def test_set_that_takes_too_many_steps_leaves_its_neighbours_alone() -> None:
    experiment = specimen({"time_s": [0.0], "value": ["q"]})
    values = {"q": np.array([5e3, 80e3, 0.0, 100e3, 7e3, 50e3, 60e3, 2e3])}
    found = checked(experiment, charring(), values, LANES, accuracy=Accuracy(most_steps=100))
    assert {c.status for c in found} >= {Status.TOO_MANY_STEPS, Status.UNBURNT}


# Surroundings and substance

DEPTHS_M = (0.0, 0.3e-3, 1.1e-3, 2.7e-3, 5e-3)
PROBES_M = tuple(Place(depth, follows=f) for f in get_args(Follows) for depth in DEPTHS_M)


def probed(probes_m: Probes) -> dict[str, Request]:
    return SHORT | {f"probe_{p}": SHORT["back_temperature"] for p in range(len(probes_m))}


PROBED = probed(PROBES_M)


def test_probes_measure_the_same_where_the_cells_are_as_many() -> None:
    material = charring(virgin={"density_kg_m3": "rho"})
    mixed = {"thickness_m": 5e-3, "composition": {"V": 0.61, "M": 0.28, "C": "rest"}}
    values = {"rho": np.linspace(1000.0, 1300.0, LANES)}
    accuracy = Accuracy(cells=57)
    experiment = specimen(layers=(mixed,))
    found = checked(experiment, material, values, LANES, PROBED, accuracy, PROBES_M)
    assert all_differ(found)


def test_probes_measure_the_same_beside_sets_of_more_cells() -> None:
    experiment = specimen(80.0, layers=SIZED, foil={**FOIL, "contact_m2K_W": 1e-3})
    values = {"size": np.linspace(5e-3, 30e-3, LANES)}
    found = checked(experiment, charring(), values, LANES, PROBED, probes_m=PROBES_M)
    assert len({c.cells for c in found}) >= 4


def test_places_differ_between_sets() -> None:
    layers = ({"thickness_m": "size"}, {"thickness_m": 3e-3})
    values = {
        "size": np.linspace(1e-3, 4e-3, LANES + 3),
        "depth": np.linspace(3e-3, 1e-3, LANES + 3),
    }
    places = (Place("depth"), Place("depth", follows="fixture"), Place(layer=1), Place(layer=2))
    experiment = specimen(60.0, layers=layers, back={})
    asked = probed(places)
    found = checked(experiment, charring(), values, LANES + 3, asked, probes_m=places)
    assert all_differ(found)
    for curves in found:
        back = curves.signals["back_temperature"]
        np.testing.assert_allclose(curves.signals["probe_3"], back, rtol=1e-12)


def test_flux_table_with_a_step_has_its_own_fluxes_in_each_lane() -> None:
    table = {
        "time_s": [0.0, 20.0, 50.0, 50.0, 120.0, 200.0],
        "value": [0.0, "q", "q", "p", 6e4, 0.0],
    }
    values = {
        "q": np.array([0.0, 1e4, 2e4, 0.0, 4e4, 5e4, 6e4, 7e4]),
        "p": np.array([7e4, 6e4, 2e4, 0.0, 4e4, 3e4, 2e4, 1e4]),
    }
    assert all_differ(checked(specimen(table), charring(), values, LANES))


@pytest.mark.parametrize("transmitted", ["foil", "lost"])
def test_clear_and_opaque_sets_run_side_by_side(transmitted: str) -> None:
    kappa = np.array([0.0, 500.0, 0.0, 2000.0, 100.0, 0.0, 1e4, 800.0])
    parts = charring().components.items()
    clear = {name: part.model_copy(update={"absorption_1_m": "kappa"}) for name, part in parts}
    material = charring().model_copy(update={"components": clear})
    experiment = specimen(foil=FOIL, transmitted=transmitted, absorption_length_m="length")
    values = {"kappa": kappa, "length": np.array([0.0, 0.0, 1e-3, 5e-4, 0.0, 0.0, 0.0, 3e-3])}
    found = checked(experiment, material, values, LANES)
    assert_same([found[0]], [found[5]])
    assert all_differ(found[:5] + found[6:])


def test_all_of_the_surroundings_differ_from_set_to_set() -> None:
    draw = np.random.default_rng(11)
    side = {"h_cube_root_W_m2K43": "C", "gas_rise_K": "rise", "gas_rise_time_s": "tau"}
    experiment = specimen(
        back={**BEHIND, **side, "loss_factor": "share"},
        front={**side, "rise_time_s": "tau", "drift_1_s": "drift", "drift_time_s": "tau"},
        foil={**FOIL, "contact_m2K_W": "contact"},
        edge={"h_W_m2K": "h", "perimeter_per_area_1_m": 40.0},
        emissivity_change="change",
        emissivity_depth="depth",
    )
    most = {
        "C": 2.0,
        "rise": 80.0,
        "tau": 50.0,
        "share": 1.5,
        "drift": 1e-3,
        "contact": 5e-3,
        "h": 20.0,
        "change": -0.3,
        "depth": 1e-4,
    }
    present = draw.random((len(most), LANES)) < 0.5
    drawn = draw.random((len(most), LANES)) * present
    values = {n: top * row for (n, top), row in zip(most.items(), drawn, strict=True)}
    assert all_differ(checked(experiment, charring(), values, LANES))


def test_power_of_temperature_is_the_same_for_exponents_that_numpy_knows() -> None:
    # A plain exponent of 0.5 or 2 numpy replaces by a root or a square.
    law = {"value": 0.2, "exponent": "n", "reference_temperature_K": 310.0}
    material = charring(
        virgin={"conductivity_W_mK": law, "specific_heat_J_kgK": law | {"value": 2e3}}
    )
    values = {"n": np.array([0.0, 0.5, 1.0, 2.0, -1.0, 0.7, -0.5, 0.3])}
    assert all_differ(checked(specimen(), material, values, LANES, SHORT))


def test_properties_in_other_words_give_the_same_curves() -> None:
    # Components described alike are looked up once, and numbers are not looked up at all.
    def curves(k_char: Any, k_virgin: Any) -> list[dict[str, object]]:
        material = charring(
            virgin={"conductivity_W_mK": k_virgin}, char={"conductivity_W_mK": k_char}
        )
        return [bits(c) for c in checked(specimen(), material, {"q": q}, LANES, SHORT)]

    q = np.linspace(0.1, 0.3, LANES)
    plain, law = 0.15, {"value": 0.15, "exponent": 0.0}
    expected = curves(plain, "q")
    assert curves(law, "q") == expected == curves(plain, {"value": "q", "exponent": 0.0})


def test_sets_that_do_not_react_run_side_by_side() -> None:
    values = {"k": np.linspace(0.1, 0.4, LANES), "T0": np.linspace(280.0, 350.0, LANES)}
    experiment = specimen()
    sample = experiment.sample.model_copy(update={"initial_temperature_K": "T0"})
    experiment = experiment.model_copy(update={"sample": sample})
    assert all_differ(checked(experiment, inert_material(conductivity="k"), values, LANES, SHORT))


# Reactions

NU = np.array([0.0, 0.2, 0.0, 0.4, 0.2, 0.0, 0.7, 0.1])
ORDER = np.array([1.0, 1.0, 2.0, 0.5, 1.0, 1.5, 1.0, 0.0])
TO_CHAR = {"reactant": "M", "products": {"C": 0.3}, **SLOW, **HEATED}
NETWORKS = {
    "orders": ({**SIMPLE, "order": "n"},),
    "autocatalysis": ({**SIMPLE, "order": "n", "catalysis": "K"},),
    "competing": (
        {"reactant": "V", "products": {"C": "nu"}, **SLOW, "order": "n", "catalysis": "K"},
        {"reactant": "V", "products": {"M": 0.1}, **FAST, "A_1_s": "A"},
    ),
    "consecutive": ({"reactant": "V", "products": {"M": "nu"}, **SLOW, **HEATED}, TO_CHAR),
    "consecutive_orders": (
        {"reactant": "V", "products": {"M": "nu", "C": 0.1}, **FAST, "order": "n"},
        {**TO_CHAR, "order": "n"},
    ),
}
REACTING = {
    "nu": NU,
    "n": ORDER,
    "K": np.array([0.0, 5.0, 0.0, 2.0, 9.0, 0.0, 0.0, 1.0]),
    "A": np.where(NU > 0.0, 1e8, 0.0),
}


@pytest.mark.parametrize("name", NETWORKS)
def test_reactions_of_a_slab_belong_to_their_set(name: str) -> None:
    found = checked(specimen(60.0), charring(*NETWORKS[name]), REACTING, LANES)
    assert len({str(bits(c)) for c in found}) >= 5


# TGA


def program(rate_K_min: float, points: int = 200, **more: Any) -> tuple[Tga, Request]:
    experiment = Tga.model_validate(
        {
            "kind": "tga",
            "heating_rate_K_min": rate_K_min,
            "signals": {"mass_fraction": {"file": "synthetic"}},
            **more,
        }
    )
    temperature = np.linspace(300.0, 900.0, points)
    return experiment, Request((temperature - 300.0) * 60.0 / rate_K_min, temperature_K=temperature)


def heated(
    material: Material, values: Values, sets: int, *given: tuple[Tga, Request]
) -> list[list[Curves]]:
    """Return the curves of programs and sets at once, which are those of each alone."""
    experiments, asked = zip(*given, strict=True)
    found = simulate_tgas(experiments, material, values, asked, sets=sets)
    for curves, one in zip(found, given, strict=True):
        alone = [simulate_tga(one[0], material, of_set(values, s), one[1]) for s in range(sets)]
        assert_same(curves, alone)
    return found


@pytest.mark.parametrize("sets", [1, FEW, LANES])
def test_programs_in_one_call_are_as_alone(sets: int) -> None:
    given = program(10.0, lag_s="lag"), program(100.0, 77), program(2.0, 31, lag_s="lag")
    values = {"lag": np.linspace(0.0, 12.0, sets)}
    found = heated(charring(), values, sets, *given)
    assert [curves[0].signals["mass_fraction"].size for curves in found] == [200, 77, 31]


@pytest.mark.parametrize("name", NETWORKS)
def test_reactions_and_lag_of_a_powder_belong_to_their_set(name: str) -> None:
    given = program(10.0, lag_s="lag"), program(100.0, lag_s="lag")
    values = REACTING | {"lag": np.array([0.0, 5.0, 0.0, 2.0, 0.0, 9.0, 1.0, 0.0])}
    (found, _) = heated(charring(*NETWORKS[name]), values, LANES, *given)
    assert len({str(bits(c)) for c in found}) >= 5


@pytest.mark.parametrize("sets", [2, FEW + 1, LANES, LANES + 1, 2 * LANES + FEW + 1])
def test_number_of_sets_of_a_powder_does_not_matter(sets: int) -> None:
    draw = np.random.default_rng(sets)
    values = {"lag": draw.uniform(0.0, 9.0, sets), "n": draw.uniform(0.5, 2.0, sets)}
    heated(charring(*NETWORKS["orders"]), values, sets, program(20.0, 50, lag_s="lag"))
