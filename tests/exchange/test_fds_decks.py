"""Decks for FDS: golden ones, every effect, and the traps of its versions."""

import difflib
import os
import re
from pathlib import Path

import numpy as np
import pytest
from bases import Base, having
from decks import base, deck_of, keys, lines, predicted, with_effect

from pyrofit.constants import STEFAN_BOLTZMANN as SIGMA
from pyrofit.effects import known_effects
from pyrofit.experiments import Cone
from pyrofit.model.slab import SlabExperiment
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit_exchange.fds.exposure import surroundings
from pyrofit_exchange.fds.include import FACTOR
from pyrofit_exchange.fds.namelists import unique
from pyrofit_exchange.fds.orders import first_order_sum, same_half_time
from pyrofit_exchange.fds.remarks import Remark
from pyrofit_exchange.fds.slab import Deck
from pyrofit_exchange.fds.unwritten import unwritten
from pyrofit_exchange.fds.versions import NEW, OLD, FdsError, Version, version_of

HERE = Path(__file__).parent / "data"
WRITE = bool(os.environ.get("PYROFIT_WRITE_GOLDEN"))
"""Whether golden files are written instead of compared with."""
NUMBER = re.compile(r"-?\d+\.?\d*(?:e[+-]?\d+)?")
EXPERIMENTS = ("capa_25", "capa_60", "tga_10K")

APPROXIMATE, LEFT_OUT, WHEN_READ = "approximate", "left out", "when read"
REMARKS = {
    "balance_drift": {WHEN_READ},
    "bubbling": {LEFT_OUT},
    "char_oxidation": {APPROXIMATE, LEFT_OUT},
    "edge_loss": {LEFT_OUT},
    "emissivity_conversion": {LEFT_OUT},
    "gas_enthalpy": {LEFT_OUT},
    "in_depth": {APPROXIMATE},
    "in_depth_bands": {APPROXIMATE},
    "in_depth_lost": {APPROXIMATE, LEFT_OUT},
    "reaction_order": {APPROXIMATE},
    "swelling": {LEFT_OUT},
    "tga_lag": {WHEN_READ},
    "tga_offset": {WHEN_READ},
    "time_offset": {WHEN_READ},
}
"""Effects that are not exact; docs/fds.md says the same."""


def same(found: list[str], golden: list[str]) -> None:
    """Compare lines: the words exactly, numbers to what a simulation may change."""
    assert [NUMBER.sub("#", line) for line in found] == [NUMBER.sub("#", g) for g in golden]
    for line, other in zip(found, golden, strict=True):
        numbers = [np.array(NUMBER.findall(text), float) for text in (line, other)]
        np.testing.assert_allclose(*numbers, rtol=2e-3 if "T_END" in line else 1e-6, err_msg=line)


def _few(shown: list[str]) -> list[str]:
    """Leave out nine of ten points of ramps."""
    ramps = [n for n, line in enumerate(shown) if line[1:].startswith("&RAMP")]
    left_out = {n for k, n in enumerate(ramps) if k % 10}
    return [line for n, line in enumerate(shown) if n not in left_out]


def check_golden(name: str, found: list[str]) -> None:
    path = HERE / name
    if WRITE:
        path.write_text("\n".join(found) + "\n")
    same(found, path.read_text().splitlines())


@pytest.mark.parametrize("version", [OLD, NEW], ids=lambda v: v.name)
@pytest.mark.parametrize("name", EXPERIMENTS)
def test_deck_is_the_golden_one(name: str, version: Version) -> None:
    check_golden(f"{name}_{version.name}.fds", lines(deck_of(base(), name, version)))


def test_effects_change_the_deck_as_stored() -> None:
    # The same length of the test, so that the difference is the effect's alone.
    like, found = predicted(base(), "capa_25"), []
    plain = {name: lines(deck_of(base(), name, OLD, like)) for name in ("capa_25", "tga_10K")}
    for effect in known_effects():
        changed = with_effect(base(), effect)
        found.append(f"EFFECT {effect}")
        for name, before in plain.items():
            after = lines(deck_of(changed, name, OLD, like))
            shown = difflib.unified_diff(before, after, name, name, n=0, lineterm="")
            found += _few([line for line in shown if not line.startswith("@@")])
    check_golden("effects.diff", found)


@pytest.mark.parametrize("version", [OLD, NEW], ids=lambda v: v.name)
@pytest.mark.parametrize("effect", list(known_effects()))
def test_no_effect_is_dropped_without_a_word(effect: str, version: Version) -> None:
    changed = with_effect(base(), effect)
    like = predicted(base(), "capa_25")
    remarks: set[Remark] = set()
    in_lines = False
    for name in ("capa_25", "tga_10K"):
        before, after = (deck_of(of, name, version, like) for of in (base(), changed))
        remarks |= set(after.remarks)
        in_lines |= before.namelists != after.namelists
    kinds = {remark.kind for remark in remarks}
    assert kinds == REMARKS.get(effect, set())
    assert in_lines or kinds


@pytest.mark.parametrize("number", ["density", "conductivity"])
def test_a_factor_of_a_piece_is_named(number: str) -> None:
    slab = base().experiments["capa_25"]
    assert isinstance(slab, SlabExperiment)
    other = slab.model_copy(
        update={"sample": slab.sample.model_copy(update={f"{number}_factor": 1.1})}
    )
    said = {r.what for r in unwritten(other, base().values)}
    assert said - {r.what for r in unwritten(slab, base().values)} == {
        f"{number} of the piece, 1.1 times the material's (sample.{number}_factor)"
    }


def test_an_order_is_a_sum_of_first_orders() -> None:
    tau = np.geomspace(1e-3, 1e4, 2000)
    for order, bound in ((1.1, 5e-4), (1.5, 5e-4), (2.0, 1e-3), (2.5, 2e-3), (3.0, 3e-3)):
        parts = first_order_sum(order)
        mass = sum(w * np.exp(-a * tau) for w, a in parts)
        exact = (1.0 + (order - 1.0) * tau) ** (-1.0 / (order - 1.0))
        assert np.abs(mass - exact).max() < bound
        assert sum(w for w, _ in parts) == pytest.approx(1.0, abs=1e-12)


def test_first_order_in_place_of_another_reaches_one_half_as_early() -> None:
    # Order 0.5: m = (1 - tau/2)^2 is one half at tau = 2 - sqrt(2).
    assert np.exp(-same_half_time(0.5) * (2.0 - np.sqrt(2.0))) == pytest.approx(0.5)


def test_an_order_below_one_is_named() -> None:
    deck = deck_of(having(base(), {"reaction_order": {"order": 0.7}}), "tga_10K")
    (remark,) = deck.remarks
    assert remark.kind == APPROXIMATE
    assert "reactions.B.order" in remark.what
    assert "below 1" in remark.how


def net(deck: Deck, T: float) -> float:
    """Return the net flux [W/m2] into the front as FDS has it."""
    (surface,), (misc,) = keys(deck, "SURF"), keys(deck, "MISC")
    T_0 = float(str(misc["TMPA"][0])) + ICE_POINT_K
    q = 1e3 * float(str(surface["EXTERNAL_FLUX"][0]))
    h = float(str(surface["HEAT_TRANSFER_COEFFICIENT"][0]))
    eps = float(str(keys(deck, "MATL")[0]["EMISSIVITY"][0]))
    return eps * (q + SIGMA * (T_0**4 - T**4)) + h * (T_0 - T)


@pytest.mark.parametrize("T", [300.0, 600.0, 900.0])
def test_one_temperature_before_the_front_takes_the_same_heat_as_two(T: float) -> None:
    experiment = base().experiments["capa_60"]
    assert isinstance(experiment, SlabExperiment)
    front, eps = experiment.front, base().values["eps_a"]
    given = [front.flux_W_m2, front.h_W_m2K, front.gas_temperature_K, front.wall_temperature_K]
    q, h, gas, wall = (float(str(x)) for x in given)
    expected = eps * (q + SIGMA * (wall**4 - T**4)) + h * (gas - T)
    found = net(deck_of(base(), "capa_60"), T)
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-3 * q)


def two_temperatures_behind() -> Base:
    experiment = base().experiments["capa_25"]
    assert isinstance(experiment, SlabExperiment)
    back = experiment.back.model_copy(update={"wall_temperature_K": 350.0})
    changed = experiment.model_copy(update={"back": back})
    return Base(base().material, {**base().experiments, "capa_25": changed}, base().values)


def test_one_temperature_behind_takes_the_same_heat_as_two() -> None:
    of = two_temperatures_behind()
    experiment = of.experiments["capa_25"]
    assert isinstance(experiment, SlabExperiment)
    out = surroundings(experiment, of.values, predicted(of, "capa_25"), 0.9, True)
    assert out.h_back is not None
    assert out.h_back == pytest.approx(4.0)
    T, eps = 600.0, 0.95
    expected = 4.0 * (T - 300.0) + eps * SIGMA * (T**4 - 350.0**4)
    found = out.h_back * (T - out.back_K) + eps * SIGMA * (T**4 - out.back_K**4)
    assert found == pytest.approx(expected, rel=1e-9)


def test_yields_add_up_to_one_as_they_are_printed() -> None:
    of = having(base(), {"char_layer": {"yield": 0.0812345678912}})
    for matl in keys(deck_of(of, "capa_25"), "MATL"):
        if "N_REACTIONS" in matl:
            total = sum(float(str(v[0])) for k, v in matl.items() if k.startswith("NU_"))
            assert total == pytest.approx(1.0, abs=1e-12)


def test_the_rate_at_the_reference_temperature_is_kept_with_the_gas_constant_of_fds() -> None:
    for matl, T in zip(keys(deck_of(base(), "tga_10K"), "MATL"), ("T_A", "T_B"), strict=False):
        A, E = (float(str(matl[key][0])) for key in ("A(1)", "E(1)"))
        k = A * np.exp(-E / (8.314472 * base().values[T]))
        assert k == pytest.approx(1e-3, rel=1e-7)


def test_versions_differ_in_the_keys_that_change_a_curve() -> None:
    like = predicted(base(), "capa_25")
    old, new = (deck_of(base(), "capa_25", v, like) for v in (OLD, NEW))
    (before,), (after,) = keys(old, "SURF"), keys(new, "SURF")
    assert before["TMP_BACK"] == after["TMP_GAS_BACK"]
    assert "TMP_GAS_BACK" not in before
    assert "TMP_BACK" not in after
    assert not any("ADJUST_H" in matl for matl in keys(old, "MATL"))
    reacting = [matl for matl in keys(new, "MATL") if "N_REACTIONS" in matl]
    assert reacting
    assert all(matl["ADJUST_H"] == [False] for matl in reacting)
    assert keys(new, "TIME")[0]["LOCK_TIME_STEP"] == [True]
    assert "LOCK_TIME_STEP" not in keys(old, "TIME")[0]


def test_every_layer_starts_at_the_same_temperature_and_has_uniform_cells() -> None:
    of = having(base(), {"foil_contact": {"resistance_m2K_W": 1e-3}})
    (surface,) = keys(deck_of(of, "capa_25"), "SURF")
    assert surface["TMP_INNER(1:3)"] == pytest.approx([24.35] * 3)
    assert surface["STRETCH_FACTOR(1:3)"] == [1.0, 1.0, 1.0]
    assert surface["MATL_ID(2,1)"] == ["CONTACT"]


def test_no_key_is_written_that_overrides_the_kinetics() -> None:
    text = "\n".join(lines(deck_of(base(), "capa_25")))
    for key in ("REFERENCE_TEMPERATURE", "REFERENCE_RATE", "PYROLYSIS_RANGE", "ASSUMED_GAS"):
        assert key not in text


def test_identifiers_that_fds_would_cut_stay_different() -> None:
    found = unique([f"{'a' * 60}{n}" for n in range(12)], 30)
    assert len(set(found.values())) == 12
    assert max(map(len, found.values())) <= 30


def test_the_last_versions_of_6_7_lack_a_key_and_count_the_order_otherwise() -> None:
    first, last = version_of("6.7.4"), version_of("6.7.9")
    assert (first.cube_root, first.layer_order) == (True, True)
    assert (last.cube_root, last.layer_order) == (False, False)
    assert last.back_gas == "TMP_BACK"


def with_cube_root() -> Base:
    experiment = base().experiments["capa_25"]
    assert isinstance(experiment, SlabExperiment)
    back = experiment.back.model_copy(update={"h_W_m2K": 0.0, "h_cube_root_W_m2K43": 1.31})
    changed = experiment.model_copy(update={"back": back})
    return Base(base().material, {**base().experiments, "capa_25": changed}, base().values)


def test_natural_convection_is_a_coefficient_or_a_named_mean() -> None:
    of = with_cube_root()
    like = predicted(of, "capa_25")
    old, new = (deck_of(of, "capa_25", v, like) for v in (OLD, NEW))
    (before,), (after,) = keys(old, "SURF"), keys(new, "SURF")
    assert before["C_VERTICAL"] == [1.31]
    assert "HEAT_TRANSFER_COEFFICIENT_BACK" not in before
    assert not old.remarks
    mean = 1.31 * np.mean(np.abs(like.back_K - 300.0) ** (1.0 / 3.0))
    assert after["HEAT_TRANSFER_COEFFICIENT_BACK"] == pytest.approx([mean])
    assert [r.kind for r in new.remarks] == [APPROXIMATE]


def test_a_flame_adds_to_the_flux_while_it_burns() -> None:
    plain = base().experiments["capa_25"]
    keys_of = plain.model_dump(exclude={"kind", "repeat", "uncertain", "repeats"})
    flame = {"flux_W_m2": 12000.0, "ignition_s": 200.0, "ends_s": 900.0}
    cone = Cone.model_validate(keys_of | {"kind": "cone", "flame": flame})
    of = Base(base().material, {**base().experiments, "cone": cone}, base().values)
    deck = deck_of(of, "cone", like=predicted(base(), "capa_25"))
    points = [(p["T"][0], p["F"][0]) for p in keys(deck, "RAMP")]
    t, F = np.array(points, float).T
    (surface,) = keys(deck, "SURF")
    q = float(str(surface["EXTERNAL_FLUX"][0])) * np.interp([100.0, 500.0, 1000.0], t, F)
    np.testing.assert_allclose(q - q[0], [0.0, 12.0, 0.0], atol=1e-4)


@pytest.mark.parametrize("text", ["6.6", "5", "", "newest"])
def test_an_unknown_version_is_refused(text: str) -> None:
    with pytest.raises(FdsError, match=r"give 6\.7 or 6\.8\+"):
        version_of(text)


def test_a_translucent_sample_switches_every_layer() -> None:
    of = having(base(), {"in_depth": {"length_m": 3.5e-4}})
    found = {str(m["ID"][0]): m for m in keys(deck_of(of, "capa_25"), "MATL")}
    assert found["B"]["ABSORPTION_COEFFICIENT"] == pytest.approx([0.4 / 3.5e-4])
    assert found["FOIL"]["ABSORPTION_COEFFICIENT"] == [1e7]
    assert all("ABSORPTION_COEFFICIENT" not in m for m in keys(deck_of(of, "tga_10K"), "MATL"))


def test_the_grid_of_a_fire_is_stated() -> None:
    assert FACTOR == 0.5
