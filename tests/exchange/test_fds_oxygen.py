"""Reactions with oxygen in decks of FDS, and read from them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from bases import Base, having
from decks import base, deck_of, keys, predicted

from pyrofit.experiments import Cone, Tga
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit_exchange.fds.export import text_of_file
from pyrofit_exchange.fds.imported import import_fds
from pyrofit_exchange.fds.predicted import predict_heated
from pyrofit_exchange.fds.versions import NEW, OLD
from pyrofit_exchange.gpyro.data import slab_data
from pyrofit_exchange.steps import steps_of

AIR = 0.209
Y_AIR = AIR * 31.9988 / (AIR * 31.9988 + (1.0 - AIR) * 28.0134)
LINES = """
&MATL ID='CHAR', DENSITY=100., CONDUCTIVITY=0.1, SPECIFIC_HEAT=1., N_REACTIONS=2
      A(1)=1E7, E(1)=1.2E5, NU_SPEC(1,1)=1., SPEC_ID(1,1)='CO2', N_O2(1)=0.68
      HEAT_OF_REACTION(1)=-25000.
      A(2)=1E7, E(2)=1.2E5, NU_SPEC(1,2)=1., SPEC_ID(1,2)='CO2', N_O2(2)=1.
      GAS_DIFFUSION_DEPTH(2)=0.002 /
&SURF ID='S', MATL_ID='CHAR' /
"""


def burning(**oxygen: float) -> Base:
    """PMMA whose residue burns; ``oxygen`` of some tests replaces that of air."""
    made = having(base(), {"char_oxidation": {"rate_1_s": 2e-3}})
    experiments = {
        n: e.model_copy(update={"oxygen": oxygen.get(n, AIR)}) for n, e in made.experiments.items()
    }
    return replace(made, experiments=experiments)


def char(deck: Any) -> dict[str, list[Any]]:
    return next(of for of in keys(deck, "MATL") if of["ID"] == ["residue"])


@pytest.mark.parametrize("name", ["capa_25", "tga_10K"])
def test_deck_in_air_has_the_reaction_and_its_oxygen(name: str) -> None:
    like = predicted(base(), "capa_25")
    deck = deck_of(burning(), name, NEW, like)
    of = char(deck)
    assert (of["N_O2(1)"], of["GAS_DIFFUSION_DEPTH(1)"]) == ([1.0], [1e-3])
    assert of["HEAT_OF_REACTION(1)"][0] < 0.0
    species = {str(s["ID"][0]): s for s in keys(deck, "SPEC")}
    assert list(species) == ["NITROGEN", "OXYGEN", "METHANE"]
    assert species["NITROGEN"]["BACKGROUND"] == [True]
    assert species["OXYGEN"]["MASS_FRACTION_0"] == [pytest.approx(Y_AIR, abs=1e-8)]
    assert {r.kind for r in deck.remarks if "oxygen of" in r.what} == {"approximate"}
    assert {r.kind for r in deck.remarks if "oxygen_use" in r.what} == {"left out"}


def test_deck_without_oxygen_leaves_the_reaction_out() -> None:
    # FDS would run it as in pure oxygen where it knows no species OXYGEN.
    deck = deck_of(burning(tga_10K=0.0), "tga_10K", NEW)
    plain = deck_of(base(), "tga_10K", NEW)
    assert "N_O2(1)" not in char(deck)
    assert deck.namelists == plain.namelists


def test_deck_of_a_flame_names_the_oxidation_that_is_left_out() -> None:
    like = predicted(base(), "capa_25")
    slab = burning().experiments["capa_25"]
    flame = {"ignition_s": 60.0, "ends_s": 300.0}
    cone = Cone.model_validate(slab.model_dump() | {"kind": "cone", "flame": flame})
    deck = deck_of(replace(burning(), experiments={"cone": cone}), "cone", NEW, like)
    assert "N_O2(1)" not in char(deck)
    (remark,) = [r for r in deck.remarks if "oxygen" in r.what]
    assert remark.kind == "left out"


def test_files_of_other_programs_name_the_reaction_that_they_leave_out() -> None:
    of, like = burning(), predicted(base(), "capa_25")
    slab = of.experiments["capa_25"]
    assert isinstance(slab, SlabExperiment)
    found = slab_data("capa_25", slab, of.material, of.values, like)
    (remark,) = [r for r in found.remarks if "oxygen" in r.what]
    assert remark.kind == "left out"
    names = list(of.material.components)
    steps = steps_of(of.material, of.values, names, 8.314)
    assert len(steps) == len(steps_of(base().material, of.values, names, 8.314))


def test_order_and_depth_are_read_with_the_default_of_fds() -> None:
    found = import_fds(LINES, "x.fds", NEW)
    first, second = found.material["reactions"].values()
    assert (first["oxygen_order"], first["oxygen_depth_m"]) == (0.68, 1e-3)
    assert (second["oxygen_order"], second["oxygen_depth_m"]) == (1.0, 2e-3)
    assert first["heat_of_reaction_J_kg"] == -2.5e7
    assert not [said for said in found.remarks if "N_O2" in said or "DIFFUSION" in said]


def test_an_export_that_is_imported_burns_as_before() -> None:
    text = text_of_file(deck_of(burning(), "tga_10K"), [])
    material = Material.model_validate(import_fds(text, "x.fds", OLD).material)
    experiment = Tga(kind="tga", heating_rate_K_min=10.0, oxygen=AIR)
    T = np.arange(300.0, 1000.0, 2.0)
    before, after = (
        predict_heated(experiment, of, base().values, Accuracy())(T)
        for of in (burning().material, material)
    )
    np.testing.assert_allclose(after, before, atol=1e-6)
    assert before[-1] < 5e-4  # of the thousandth that PMMA leaves


def test_surface_oxidation_of_vegetation_is_left_out_with_the_way_out() -> None:
    line = """
&SURF ID='GROUND', MATL_ID='CHAR', THICKNESS=0.01 /
&MATL ID='CHAR', DENSITY=300., CONDUCTIVITY=0.05, SPECIFIC_HEAT=1., SURFACE_OXIDATION_MODEL=T,
      A=465., E=68000., SPEC_ID='PRODUCTS','AIR', NU_SPEC=8.13,-7.17, MATL_ID='ASH', NU_MATL=0.04,
      HEAT_OF_REACTION=-25000. /
&MATL ID='ASH', DENSITY=67., CONDUCTIVITY=0.1, SPECIFIC_HEAT=1. /
"""
    found = import_fds(line, "x.fds", NEW)
    assert not found.material.get("reactions")
    (said,) = [remark for remark in found.remarks if "SURFACE_OXIDATION_MODEL" in remark]
    assert "left out" in said
    assert "oxygen_order" in said
