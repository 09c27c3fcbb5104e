"""Effects put into a description: what they make of it, what is refused, what is documented."""

import re
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bases import (
    Base,
    Curve,
    Numbers,
    assert_same,
    changes,
    curves_of,
    having,
    pmma,
    strength,
    wood,
)

from pyrofit.effects import known_effects
from pyrofit.effects.apply import with_effects
from pyrofit.effects.base import changed
from pyrofit.effects.page import effects_page
from pyrofit.experiments import Gasification
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material
from pyrofit.model.properties import Changed
from pyrofit.model.slab import Backing, Layer
from pyrofit.model.slab_faces import Back

DOCS = Path(__file__).parents[2] / "docs"
EFFECTS = known_effects()
BASES = {"pmma": pmma(), "wood": wood()}


@pytest.fixture(scope="module")
def base_curves() -> dict[str, dict[str, Curve]]:
    return {name: curves_of(base) for name, base in BASES.items()}


def test_order_of_choice_does_not_matter() -> None:
    chosen = {
        name: {strength(effect): effect.strength[strength(effect)].typical}
        for name, effect in EFFECTS.items()
        if name not in {"in_depth_bands", "in_depth_lost", "gas_heating", "flux_decay"}
    }
    base = BASES["pmma"]
    one = with_effects(base.material, base.experiments, chosen)
    other = with_effects(base.material, base.experiments, dict(reversed(chosen.items())))
    assert one == other


def test_changes_of_one_property_are_nested() -> None:
    base = BASES["pmma"]
    chosen: Numbers = {"c_T": {"slope_1_K": 1e-3}, "glass_transition": {"step_J_kgK": 400.0}}
    twice = having(having(base, chosen), {"c_T": {"slope_1_K": "b"}})
    prop = twice.material.components["B"].specific_heat_J_kgK
    assert isinstance(prop, Changed)
    assert isinstance(prop.of, Changed)
    assert isinstance(prop.of.of, Changed)
    assert (prop.slope_1_K, prop.of.step, prop.of.of.slope_1_K) == ("b", 400.0, 1e-3)
    assert prop.of.of.of == "cp_a"


def test_same_effect_in_two_halves_is_nearly_the_whole() -> None:
    half: Numbers = {"glass_transition": {"step_J_kgK": 200.0}}
    whole = having(BASES["pmma"], {"glass_transition": {"step_J_kgK": 400.0}})
    halves = having(having(BASES["pmma"], half), half)
    assert max(changes(curves_of(halves), curves_of(whole)).values()) < 1e-12


def test_volatile_takes_its_share_from_the_main_component() -> None:
    given: Numbers = {"volatile": {"share": 0.02}}
    assert having(BASES["pmma"], given).material.composition == {
        "A": "w_A",
        "B": "rest",
        "extra_volatile": 0.02,
    }
    assert having(BASES["wood"], given).material.composition == {
        "wood": "rest",
        "extra_volatile": 0.02,
    }


def test_char_is_left_over(base_curves: dict[str, dict[str, Curve]]) -> None:
    curves = curves_of(having(BASES["pmma"], {"char_layer": {"yield": 0.1}}))
    more = curves["TGA 10"][-1] - base_curves["pmma"]["TGA 10"][-1]
    assert more == pytest.approx(0.1 * 0.975, rel=1e-12)


def test_volatile_is_gone_before_the_main_reaction() -> None:
    dry = replace(BASES["pmma"], values=BASES["pmma"].values | {"w_A": 0.0})
    given = {"share": 0.05, "temperature_K": 380.0, "E_J_mol": 1.5e5}
    wet = curves_of(having(dry, {"volatile": given}))["TGA 10"]
    # At 450 K, the 75th point, PMMA itself has lost 1.6e-6 of its mass.
    assert wet[75] == pytest.approx(0.95 * curves_of(dry)["TGA 10"][75], rel=1e-9)


def test_intermediate_leaves_nothing_behind(base_curves: dict[str, dict[str, Curve]]) -> None:
    curves = curves_of(having(BASES["pmma"], {"consecutive": {"yield": 0.3}}))
    left = base_curves["pmma"]["TGA 10"][-1]
    assert curves["TGA 10"][-1] == pytest.approx(left, rel=1e-6)


def test_record_that_is_late_is_the_same_record_later(
    base_curves: dict[str, dict[str, Curve]],
) -> None:
    late = curves_of(having(BASES["pmma"], {"time_offset": {"delay_s": 5.0}}))
    for name in ("MLR 25", "T_back 60"):
        base = base_curves["pmma"][name]
        # Not at the end: that of the run, a time step ends there, is 5 s earlier.
        np.testing.assert_allclose(late[name][1:-2], base[:-3], rtol=1e-9, atol=1e-12)


def test_back_without_loss_is_an_insulated_back() -> None:
    base = BASES["pmma"]
    bare = {
        n: changed(e, back=Back()) if isinstance(e, Gasification) else e
        for n, e in base.experiments.items()
    }
    none = curves_of(having(base, {"back_loss": {"factor": 0.0}}))
    assert_same(none, curves_of(replace(base, experiments=bare)))


def test_absorption_in_depth_and_its_lost_form_differ_without_a_foil() -> None:
    # With 2 mm, exp(-2) of the radiation passes 4 mm of wood.
    found = [
        curves_of(having(BASES["wood"], {name: {"length_m": 2e-3}}))
        for name in ("in_depth", "in_depth_lost")
    ]
    assert changes(*found)["T_back 25"] > 0.02


def test_lag_moves_tga_by_rate_times_time() -> None:
    curves = curves_of(having(BASES["pmma"], {"tga_lag": {"time_s": 12.0}}))
    base = curves_of(BASES["pmma"])
    # 12 s at 10 K/min are 2 K: one point; both start undecomposed, 2 K apart.
    np.testing.assert_allclose(curves["TGA 10"][1:], base["TGA 10"][:-1], rtol=1e-6)


@pytest.mark.parametrize(
    ("chosen", "message"),
    [
        ({"back_los": {"factor": 1.0}}, "unknown effect 'back_los'. Did you mean 'back_loss'"),
        ({"melting": {"heat": 1.0}}, "'melting': unknown parameter 'heat'. Did you mean 'heat_J"),
        ({"melting": {"width_K": 9.0}}, "'melting': give its strength 'heat_J_kg'"),
        (
            {"gas_heating": {"rise_K": 9.0}, "gas_temperature": {"rise_K": 9.0}},
            "'gas_temperature': the study or another effect already sets gas_rise_K",
        ),
    ],
)
def test_wrong_choice_is_refused(chosen: Numbers, message: str) -> None:
    with pytest.raises(ValueError, match=message.replace(".", r"\.")):
        having(BASES["pmma"], chosen)


def test_effect_that_no_experiment_can_have_is_refused() -> None:
    with pytest.raises(ValueError, match="'foil_mass': no experiment can have it; it needs a foil"):
        having(BASES["wood"], {"foil_mass": {"factor": 2.0}})


@pytest.mark.parametrize(
    ("name", "key"), [("char_layer", "yield"), ("volatile", "share"), ("consecutive", "yield")]
)
def test_component_of_an_effect_does_not_replace_one_of_the_material(name: str, key: str) -> None:
    once = having(BASES["pmma"], {name: {key: 0.01}})
    with pytest.raises(ValueError, match=f"has a component 'extra_{'[a-z]+'}' already"):
        having(once, {name: {key: 0.01}})


def test_yields_above_one_are_refused() -> None:
    with pytest.raises(ValueError, match=r"(?s)'char_layer': .*the solid yields add up to 1\.1,"):
        having(BASES["wood"], {"char_layer": {"yield": 0.85}})


def test_page_of_effects_is_up_to_date() -> None:
    assert (DOCS / "effects.md").read_text(encoding="utf-8") == effects_page()


def test_documented_effect_needs_nothing_but_its_file(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    base_curves: dict[str, dict[str, Curve]],
) -> None:
    text = (DOCS / "adding.md").read_text(encoding="utf-8")
    code = text.split("```python\n")[1].split("```")[0]
    (tmp_path / "natural_convection.py").write_text(code, encoding="utf-8")
    folders = [*import_module("pyrofit.effects").__path__, str(tmp_path)]
    monkeypatch.setattr(import_module("pyrofit.effects"), "__path__", folders)
    base = BASES["pmma"]
    null = having(base, {"natural_convection": {"C": "c"}}, c=0.0)
    assert_same(curves_of(null), base_curves["pmma"])
    more = curves_of(having(base, {"natural_convection": {"C": 1.31}}))
    assert changes(more, base_curves["pmma"])["MLR 60"] > 0.1


def backed() -> tuple[Material, dict[str, Experiment]]:
    """Wood on a board, and a run on the board alone."""
    base = BASES["wood"]
    board = {"density_kg_m3": 300.0, "conductivity_W_mK": 0.1, "specific_heat_J_kgK": 900.0}
    given = base.material.model_dump()
    given["components"]["board"] = board
    name, slab = next((n, e) for n, e in base.experiments.items() if isinstance(e, Gasification))
    behind = (Backing(thickness_m=0.02, component="board"),)
    alone = (Layer(thickness_m=0.02, composition={"board": 1.0}),)
    experiments: dict[str, Experiment] = {
        name: changed(slab, sample=changed(slab.sample, backing=behind)),
        "inert": changed(slab, sample=changed(slab.sample, layers=alone)),
    }
    return Material.model_validate(given), experiments


@pytest.mark.parametrize(
    "name", ["bubbling", "c_T", "k_T", "swelling", "glass_transition", "melting"]
)
def test_effect_on_properties_leaves_boards_as_they_are_unless_it_names_them(name: str) -> None:
    material, experiments = backed()
    at = {strength(EFFECTS[name]): EFFECTS[name].strength[strength(EFFECTS[name])].typical}
    plain, _ = with_effects(material, experiments, {name: at})
    assert plain.components["board"] == material.components["board"]
    assert all(plain.components[n] != c for n, c in material.components.items() if n != "board")
    named, _ = with_effects(material, experiments, {name: {**at, "of": ("board",)}})
    assert named.components["board"] != material.components["board"]
    assert all(named.components[n] == c for n, c in material.components.items() if n != "board")


@pytest.mark.parametrize(
    "name",
    [
        "adhesive",
        "thickness",
        "emissivity_conversion",
        "gas_enthalpy",
        "in_depth",
        "in_depth_bands",
        "in_depth_lost",
    ],
)
def test_effect_on_the_sample_leaves_inert_runs_as_they_are(name: str) -> None:
    material, experiments = backed()
    at = {strength(EFFECTS[name]): EFFECTS[name].strength[strength(EFFECTS[name])].typical}
    _, made = with_effects(material, experiments, {name: at})
    assert made["inert"] == experiments["inert"]
    assert all(made[n] != e for n, e in experiments.items() if n != "inert")


@pytest.mark.parametrize(
    ("name", "of", "said"),
    [
        ("c_T", ("boar",), "unknown component 'boar'. Did you mean 'board'?"),
        ("c_T", (), "'of' must be a list of components"),
        ("back_loss", ("board",), "changes no property of components; leave out 'of'"),
    ],
)
def test_bad_choice_of_components_is_told(name: str, of: tuple[str, ...], said: str) -> None:
    material, experiments = backed()
    given = {strength(EFFECTS[name]): 0.9, "of": of}
    with pytest.raises(ValueError, match=re.escape(said)):
        with_effects(material, experiments, {name: given})


# --- laboratories ---------------------------------------------------------------------------


def two_laboratories() -> Base:
    """Return the slabs as tests of two laboratories."""
    base = BASES["pmma"]
    place = {"capa_25": "UMD", "capa_60": "Aalto"}
    slabs = {
        name: base.experiments[name].model_copy(update={"laboratory": own})
        for name, own in place.items()
    }
    return replace(base, experiments=slabs)


def test_effect_of_the_apparatus_keeps_to_the_laboratories_named() -> None:
    base = two_laboratories()
    changed = having(base, {"flux_spread": {"spread": 0.1, "laboratories": ["UMD"]}})
    assert changed.experiments["capa_25"].front.spread == 0.1
    assert changed.experiments["capa_60"] == base.experiments["capa_60"]
    both = having(base, {"flux_spread": {"spread": 0.1}})
    assert both.experiments["capa_60"].front.spread == 0.1


@pytest.mark.parametrize(
    ("effect", "laboratories", "message"),
    [
        ("flux_spread", ["UDM"], "unknown laboratory 'UDM'. Did you mean 'UMD'"),
        ("flux_spread", "UMD", "'laboratories' must be a list of names, as"),
        ("swelling", ["UMD"], "it belongs to the material, which all laboratories share"),
    ],
)
def test_laboratories_of_an_effect_must_be_known_and_its_own(
    effect: str, laboratories: Any, message: str
) -> None:
    (strength,) = known_effects()[effect].strength
    with pytest.raises(ValueError, match=re.escape(message)):
        having(two_laboratories(), {effect: {strength: 0.1, "laboratories": laboratories}})
