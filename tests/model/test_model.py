from typing import Any

import pytest
from pydantic import ValidationError

from pyrofit.experiments import Gasification, Tga
from pyrofit.model.base import Part, numbers, value_of
from pyrofit.model.material import Component, Material, Reaction, check_composition
from pyrofit.model.parameters import Parameter
from pyrofit.model.properties import Changed, Linear, PowerLaw, Table
from pyrofit.model.time_table import TimeTable

SOLID: dict[str, Any] = {
    "density_kg_m3": 1000.0,
    "conductivity_W_mK": 0.2,
    "specific_heat_J_kgK": 1500.0,
}


def material(
    reactions: dict[str, Any] | None = None,
    composition: dict[str, Any] | None = None,
    **components: Any,
) -> Material:
    return Material.model_validate(
        {
            "components": components or dict.fromkeys("ABC", SOLID),
            "reactions": reactions or {},
            "composition": composition or {"A": 1.0},
        }
    )


def reaction(reactant: str, *products: str) -> dict[str, Any]:
    return {
        "reactant": reactant,
        "products": dict.fromkeys(products, 0.1),
        "A_1_s": 1e10,
        "E_J_mol": 1.5e5,
    }


def experiment(**changes: Any) -> Gasification:
    return Gasification.model_validate(
        {
            "kind": "gasification",
            "sample": {"layers": [{"thickness_m": 0.006}]},
            "front": {"flux_W_m2": 25e3},
            "signals": {"mlr": {"file": "synthetic"}},
        }
        | changes
    )


def test_number_stands_for_itself_and_a_name_for_its_parameter() -> None:
    assert value_of(2.5, {"k": 7.0}) == 2.5
    assert value_of("k", {"k": 7.0}) == 7.0


def test_misspelt_key_names_the_nearest_one() -> None:
    with pytest.raises(ValidationError, match="Did you mean 'emissivity'"):
        Component.model_validate(SOLID | {"emisivity": 0.9})


def test_description_cannot_be_changed() -> None:
    with pytest.raises(ValidationError, match="frozen"):
        Component.model_validate(SOLID).density_kg_m3 = 1.0


@pytest.mark.parametrize("given", [True, "two words", "1e3 ", None, [1.0]])
def test_what_is_neither_number_nor_name_is_refused(given: Any) -> None:
    with pytest.raises(ValidationError):
        Component.model_validate(SOLID | {"density_kg_m3": given})


@pytest.mark.parametrize("given", [float("nan"), float("inf")])
def test_number_that_is_not_finite_is_refused(given: float) -> None:
    with pytest.raises(ValidationError, match="finite"):
        Component.model_validate(SOLID | {"density_kg_m3": given})


@pytest.mark.parametrize(
    ("given", "form"),
    [
        ({"value": 0.2, "slope_1_K": 1e-3}, Linear),
        ({"value": 0.2, "exponent": 0.5}, PowerLaw),
        ({"temperature_K": [300.0, 400.0], "value": [0.2, "k_hot"]}, Table),
        ({"of": {"value": 0.2, "exponent": 0.5}, "slope_1_K": 1e-3}, Changed),
        ({"of": {"of": "k", "step": 0.1}, "peak_area": 10.0}, Changed),
        (0.2, float),
        ("k", str),
    ],
)
def test_property_takes_the_form_its_keys_say(given: Any, form: type) -> None:
    component = Component.model_validate(SOLID | {"conductivity_W_mK": given})
    assert type(component.conductivity_W_mK) is form


@pytest.mark.parametrize(
    ("temperatures", "values", "message"),
    [
        ([300.0, 400.0], [0.2], "same length"),
        ([300.0], [0.2], "at least 2"),
        ([300.0, 300.0], [0.2, 0.3], "must increase"),
        ([400.0, 300.0], [0.2, 0.3], "must increase"),
    ],
)
def test_property_table_must_increase_in_temperature(
    temperatures: list[float], values: list[float], message: str
) -> None:
    with pytest.raises(ValidationError, match=message):
        Table(temperature_K=tuple(temperatures), value=tuple(values))


def test_every_parameter_of_a_description_is_found_with_its_place() -> None:
    given = material(
        reactions={"first": reaction("A", "C") | {"A_1_s": "A_1", "products": {"C": "nu"}}},
        A=SOLID | {"conductivity_W_mK": {"value": "k_0", "exponent": "n"}},
        B=SOLID | {"specific_heat_J_kgK": {"of": {"of": "c", "slope_1_K": "s"}, "step": "dc"}},
        C=SOLID | {"emissivity": "eps"},
    )
    found = {place: leaf for place, leaf, _ in numbers(given) if isinstance(leaf, str)}
    assert found == {
        "components.A.conductivity_W_mK.value": "k_0",
        "components.A.conductivity_W_mK.exponent": "n",
        "components.B.specific_heat_J_kgK.of.of": "c",
        "components.B.specific_heat_J_kgK.of.slope_1_K": "s",
        "components.B.specific_heat_J_kgK.step": "dc",
        "components.C.emissivity": "eps",
        "reactions.first.A_1_s": "A_1",
        "reactions.first.products.C": "nu",
    }


@pytest.mark.parametrize(
    ("place", "good", "bad"),
    [
        ("components.A.density_kg_m3", 1e-3, 0.0),
        ("components.A.conductivity_W_mK", 1e-3, -1.0),
        ("components.A.emissivity", 1.0, 1.1),
        ("components.A.expansion", 0.1, 0.0),
        ("components.C.specific_heat_J_kgK.of", 1.0, 0.0),
        ("components.C.specific_heat_J_kgK.step", -1e3, float("inf")),
        ("components.C.specific_heat_J_kgK.step_width_K", 0.1, 0.0),
        ("components.C.specific_heat_J_kgK.peak_area", -1e3, float("inf")),
        ("components.C.specific_heat_J_kgK.peak_width_K", 4.0, 3.9),
        ("reactions.first.E_J_mol", 0.0, -1.0),
        ("reactions.first.products.C", 0.0, -0.1),
        ("reactions.first.heat_of_reaction_J_kg", -1e6, float("nan")),
    ],
)
def test_numbers_carry_the_rules_of_their_place(place: str, good: float, bad: float) -> None:
    changed = {"specific_heat_J_kgK": {"of": 2000.0}}
    given = material(reactions={"first": reaction("A", "C")}, A=SOLID, C=SOLID | changed)
    rules = {where: rules for where, _, rules in numbers(given)}[place]
    assert all(rule.holds(good) for rule in rules)
    assert not all(rule.holds(bad) for rule in rules)


@pytest.mark.parametrize(
    ("place", "good", "bad"),
    [
        ("front.h_change_W_m2K", -5.0, float("inf")),
        ("front.gas_rise_K", -50.0, float("nan")),
        ("back.gas_rise_time_s", 0.0, -1.0),
        ("front.rise_time_s", 0.0, -1.0),
        ("front.spread", 1.0, 1.1),
        ("front.drift_1_s", -1.0, float("nan")),
        ("front.drift_time_s", 0.0, -1.0),
        ("back.loss_factor", 0.0, -0.1),
        ("sample.foil.contact_m2K_W", 0.0, -1e-3),
        ("sample.thickness_factor", 0.1, 0.0),
        ("sample.density_factor", 1.1, 0.0),
        ("sample.conductivity_factor", 2.0, 0.0),
        ("sample.emissivity_change", -2.0, float("nan")),
        ("sample.absorption_length_m", 0.0, -1e-4),
        ("sample.edge.h_W_m2K", 0.0, -1.0),
        ("sample.edge.perimeter_per_area_1_m", 40.0, 0.0),
        ("sample.edge.gas_temperature_K", 293.15, 20.0),
        ("signals.mlr.delay_s", -5.0, float("nan")),
        ("signals.mlr.offset", -1e-3, float("nan")),
    ],
)
def test_general_terms_carry_their_rules(place: str, good: float, bad: float) -> None:
    foil = {"thickness_m": 2e-4, "density_kg_m3": 8940.0, "specific_heat_J_kgK": 380.0}
    edge = {"h_W_m2K": 5.0, "perimeter_per_area_1_m": 40.0}
    given = experiment(
        sample={"layers": [{"thickness_m": 0.006}], "foil": foil, "edge": edge},
    )
    rules = {where: rules for where, _, rules in numbers(given)}[place]
    assert all(rule.holds(good) for rule in rules)
    assert not all(rule.holds(bad) for rule in rules)


@pytest.mark.parametrize("given", [{"delay_s": 2.0}, {"offset": "zero"}])
def test_signal_of_a_tga_experiment_has_no_delay_and_no_offset(given: dict[str, Any]) -> None:
    signals = {"mass_fraction": {"file": "synthetic", **given}}
    with pytest.raises(ValidationError, match=r"neither delay_s nor offset\. .* has lag_s"):
        Tga.model_validate({"kind": "tga", "heating_rate_K_min": 10.0, "signals": signals})


@pytest.mark.parametrize(
    ("composition", "message"),
    [
        ({"A": 0.5, "b": 0.5}, "unknown component 'b'"),
        ({"A": 0.5, "B": 0.4}, "add up to 0.9, not to 1"),
        ({"A": 0.7, "B": 0.4, "C": "rest"}, "add up to 1.1, above 1"),
        ({"A": 1.5, "B": -0.5}, "not within 0 and 1"),
        ({"A": "rest", "B": "rest"}, "only one component may be 'rest'"),
        ({"A": "x", "B": 0.5}, "one component must be 'rest'"),
    ],
)
def test_composition_that_cannot_be_whole_is_refused(
    composition: dict[str, Any], message: str
) -> None:
    with pytest.raises(ValidationError, match=message):
        material(composition=composition)
    with pytest.raises(ValueError, match=message):
        check_composition(composition, material().components)


def test_rest_may_be_nothing() -> None:
    assert material(composition={"A": 1.0, "B": "rest"}).composition["B"] == "rest"


@pytest.mark.parametrize("given", [{"reactant": "a"}, {"products": {"D": 0.1}}])
def test_reaction_of_an_unknown_component_is_refused(given: dict[str, Any]) -> None:
    with pytest.raises(ValidationError, match="reaction 'first' uses the unknown component"):
        material(reactions={"first": reaction("A") | given})


def test_reaction_that_forms_its_own_reactant_is_refused() -> None:
    with pytest.raises(ValidationError, match="forms its own reactant 'A'"):
        material(reactions={"first": reaction("A", "A")})


def test_cycle_of_reactions_is_refused() -> None:
    cycle = {"1": reaction("A", "B"), "2": reaction("B", "C"), "3": reaction("C", "A")}
    with pytest.raises(ValidationError, match="reactions of A, B, C form a cycle"):
        material(reactions=cycle)


def test_reactions_are_sorted_so_that_products_react_after_their_formation() -> None:
    given = {"last": reaction("C"), "middle": reaction("B", "C"), "first": reaction("A", "B", "C")}
    assert material(reactions=given).reaction_order() == ("first", "middle", "last")


def test_reactions_of_one_component_stay_together() -> None:
    given = {"1": reaction("B", "C"), "2": reaction("A", "B"), "3": reaction("B")}
    assert material(reactions=given).reaction_order() == ("2", "1", "3")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "give A_1_s, or reference_temperature_K with reference_rate_1_s"),
        ({"reference_temperature_K": 600.0}, "give A_1_s, or"),
        ({"reference_rate_1_s": 1e-3}, "give A_1_s, or"),
        ({"A_1_s": 1e10, "reference_rate_1_s": 1e-3}, "not both"),
        ({"A_1_s": 1e10, "reference_temperature_K": 600.0}, "not both"),
    ],
)
def test_rate_is_given_in_exactly_one_way(given: dict[str, float], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        Reaction.model_validate({"reactant": "A", "E_J_mol": 1.5e5} | given)


def test_absorption_is_given_for_every_component_or_for_none() -> None:
    with pytest.raises(ValidationError, match="absorption_1_m for every component or for none"):
        material(None, {"A": 0.5, "B": "rest"}, A=SOLID | {"absorption_1_m": 1e3}, B=SOLID)


def test_board_behind_a_translucent_material_may_be_opaque() -> None:
    with_board = material(A=SOLID | {"absorption_1_m": 1e3}, board=SOLID)
    assert with_board.own == {"A"}


@pytest.mark.parametrize(
    ("time", "flux", "message"),
    [
        ((), (), "at least 1"),
        ((0.0, 1.0), (1.0,), "same length"),
        ((1.0, 2.0), (1.0, 2.0), "start at 0"),
        ((0.0, 2.0, 1.0), (1.0, 2.0, 3.0), "must not decrease; sort"),
        ((0.0, 2.0, 2.0, 2.0), (1.0, 2.0, 3.0, 4.0), "more than twice"),
    ],
)
def test_flux_table_runs_forward_from_zero(
    time: tuple[float, ...], flux: tuple[float, ...], message: str
) -> None:
    with pytest.raises(ValidationError, match=message):
        TimeTable(time_s=time, value=flux)


def test_flux_may_step() -> None:
    assert TimeTable(time_s=(0.0, 5.0, 5.0), value=(0.0, 0.0, 1e4)).time_s[1:] == (5.0, 5.0)


def test_sample_without_layers_is_refused() -> None:
    with pytest.raises(ValidationError, match="at least 1 item"):
        experiment(sample={"layers": []})


def test_signal_of_another_experiment_is_refused() -> None:
    with pytest.raises(ValidationError, match="unknown signal 'mass_fraction'"):
        experiment(signals={"mass_fraction": {"file": "synthetic"}})
    with pytest.raises(ValidationError, match="unknown signal 'mlr'"):
        Tga.model_validate(
            {"kind": "tga", "heating_rate_K_min": 10.0, "signals": {"mlr": {"file": "x"}}}
        )


def test_back_is_insulated_unless_told() -> None:
    back = experiment().back
    assert (back.h_W_m2K, back.h_cube_root_W_m2K43, back.emissivity) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"unit": "furlong", "value": 1.0}, "unknown unit 'furlong'"),
        ({"unit": "K"}, "give a value, or limits"),
        ({"unit": "K", "lower": 1.0}, "both limits"),
        ({"unit": "K", "lower": 2.0, "upper": 2.0}, "must be below"),
    ],
)
def test_parameter_without_unit_value_or_limits_is_refused(
    given: dict[str, Any], message: str
) -> None:
    with pytest.raises(ValidationError, match=message):
        Parameter.model_validate(given)


def test_limits_of_a_parameter_become_si() -> None:
    parameter = Parameter(unit="kJ/mol", lower=100.0, upper=250.0)
    assert parameter.bounds_si == (100e3, 250e3)


def test_parameter_without_limits_has_no_bounds() -> None:
    with pytest.raises(ValueError, match="no limits"):
        assert Parameter(unit="K", value=300.0).bounds_si


def test_part_without_fields_takes_no_keys() -> None:
    class Empty(Part):
        pass

    with pytest.raises(ValidationError, match="unknown key 'x'"):
        Empty.model_validate({"x": 1})
