import math
from typing import Any

import numpy as np
import pytest

from pyrofit.experiments import Gasification
from pyrofit.model.material import Material, Reaction
from pyrofit.model.properties import Linear, PowerLaw, Table
from pyrofit.solver import lower, lower_experiment, lower_exposure, lower_network, lower_property
from pyrofit.solver.arrays import BACK_GAS, FLUX, FRONT_H, TABLE_TEMPERATURES_K, TIME

VIRGIN: dict[str, Any] = {
    "density_kg_m3": 1000.0,
    "conductivity_W_mK": 0.2,
    "specific_heat_J_kgK": 2000.0,
    "emissivity": 0.8,
}
CHAR: dict[str, Any] = {
    "density_kg_m3": "rho_c",
    "conductivity_W_mK": 0.4,
    "specific_heat_J_kgK": 1000.0,
    "emissivity": 0.95,
}
VALUES = {"rho_c": 500.0, "h": 12.0, "q": 3e4, "half": 0.5, "E": 1.5e5}


def material(
    reactions: dict[str, Any] | None = None,
    composition: dict[str, Any] | None = None,
    virgin: dict[str, Any] | None = None,
) -> Material:
    return Material.model_validate(
        {
            "components": {"A": VIRGIN | (virgin or {}), "B": VIRGIN, "char": CHAR},
            "reactions": reactions or {},
            "composition": composition or {"A": 1.0},
        }
    )


def experiment(sample: dict[str, Any] | None = None, **changes: Any) -> Gasification:
    return Gasification.model_validate(
        {
            "kind": "gasification",
            "sample": {"layers": [{"thickness_m": 0.006}]} | (sample or {}),
            "front": {"flux_W_m2": 25e3},
            "signals": {"mlr": {"file": "synthetic"}},
        }
        | changes
    )


def reaction(reactant: str, **more: Any) -> dict[str, Any]:
    return {"reactant": reactant, "A_1_s": 1e10, "E_J_mol": 1.5e5} | more


def at(table: Any, temperature_K: float) -> float:
    return float(np.interp(temperature_K, TABLE_TEMPERATURES_K, table[:, 0]))


def exposed(experiment, material):
    arrays = lower.lower_material(material, VALUES)
    share = lower_experiment.lower_share(experiment, material, VALUES)
    return lower_exposure.lower_exposure(experiment, share, arrays, VALUES)


@pytest.mark.parametrize(
    ("composition", "expected"),
    [
        ({"A": 0.25, "B": 0.75}, [0.25, 0.75, 0.0]),
        ({"B": 0.25, "A": "rest"}, [0.75, 0.25, 0.0]),
        ({"A": "rest", "B": "half", "char": 0.125}, [0.375, 0.5, 0.125]),
        ({"char": 1.0}, [0.0, 0.0, 1.0]),
    ],
)
def test_fractions_are_in_the_order_of_the_components(
    composition: dict[str, Any], expected: list[float]
) -> None:
    found = lower.fractions(composition, ["A", "B", "char"], VALUES)
    assert found.tolist() == [[share] for share in expected]


def test_constant_property_is_one_value() -> None:
    assert lower_property.property_table(0.3, VALUES).tolist() == [[0.3]]
    assert lower_property.property_table("rho_c", VALUES).tolist() == [[500.0]]


def test_linear_property_by_hand() -> None:
    table = lower_property.property_table(Linear(value=0.2, slope_1_K=1e-3), VALUES)
    assert at(table, 300.0) == pytest.approx(0.2)
    assert at(table, 552.5) == pytest.approx(0.2 * 1.2525)


def test_power_law_by_hand() -> None:
    law = PowerLaw(value=0.2, exponent=0.5, reference_temperature_K=400.0)
    table = lower_property.property_table(law, VALUES)
    assert at(table, 400.0) == pytest.approx(0.2)
    assert at(table, 900.0) == pytest.approx(0.3)


def test_table_is_linear_inside_and_constant_outside() -> None:
    law = Table(temperature_K=(300.0, 400.0), value=(1000.0, "rho_c"))
    table = lower_property.property_table(law, VALUES)
    assert [at(table, T) for T in (250.0, 350.0, 375.0, 1200.0)] == [1000.0, 750.0, 625.0, 500.0]


def test_factor_multiplies_a_table_in_both_solvers() -> None:
    given = {"temperature_K": [300.0, 400.0], "value": [1000.0, 500.0]}
    plain, twice = (
        material(virgin={"specific_heat_J_kgK": given | more}) for more in ({}, {"factor": "two"})
    )
    values = VALUES | {"two": 2.0}
    one, other = (lower.lower_material(m, values).specific_heat for m in (plain, twice))
    changed = np.any(one != other, axis=(1, 2))
    assert changed.any()
    np.testing.assert_array_equal(other[changed], 2.0 * one[changed])


def test_constants_are_stretched_beside_tables_only() -> None:
    plain = lower.lower_material(material(), VALUES)
    assert plain.conductivity.tolist() == [[[0.2]], [[0.2]], [[0.4]]]
    virgin = {"conductivity_W_mK": {"value": 0.2, "exponent": 0.7}}
    mixed = lower.lower_material(material(virgin=virgin), VALUES)
    assert mixed.conductivity.shape == (3, TABLE_TEMPERATURES_K.size, 1)
    assert (mixed.conductivity[2] == 0.4).all()
    assert mixed.specific_heat.shape == (3, 1, 1)


def test_properties_are_in_the_order_of_the_components() -> None:
    arrays = lower.lower_material(material(), VALUES)
    assert arrays.specific_volume.tolist() == [[1e-3], [1e-3], [2e-3]]
    assert arrays.emissivity.tolist() == [[0.8], [0.8], [0.95]]
    assert arrays.absorption.tolist() == [[[0.0]], [[0.0]], [[0.0]]]


def test_components_described_alike_share_their_tables() -> None:
    alike = {"B": VIRGIN | {"density_kg_m3": 700.0}, "char": CHAR}
    hot = {"conductivity_W_mK": {"value": 0.2, "exponent": 0.7}}
    components = {"A": VIRGIN, "C": VIRGIN | hot} | alike
    given = {"components": components, "composition": dict.fromkeys(components, 0.25)}
    arrays = lower.lower_material(Material.model_validate(given), VALUES)
    assert arrays.alike.tolist() == [0, 1, 0, 3]
    assert arrays.constant.tolist() == [True, False, True, True]


def test_rate_given_at_a_temperature_is_that_rate_there() -> None:
    given = Reaction(
        reactant="A", E_J_mol="E", reference_temperature_K=600.0, reference_rate_1_s=2e-3
    )
    A = lower_network.rate_factor(given, VALUES)
    assert pytest.approx(2e-3 * math.exp(1.5e5 / (8.314462618 * 600.0)), rel=1e-14) == A
    assert pytest.approx(2.29e10, rel=2e-3) == A


def test_rate_factor_given_outright_is_kept() -> None:
    assert lower_network.rate_factor(Reaction(reactant="A", E_J_mol=1.0, A_1_s=7e9), VALUES) == 7e9


def test_network_by_hand() -> None:
    reactions = {
        "second": reaction("B", products={"char": 0.25}, heat_of_reaction_J_kg=4e5),
        "first": reaction("A", products={"B": 0.5, "char": 0.125}, E_J_mol=8314.462618, order=2.0),
    }
    network = lower_network.lower_network(material(reactions), VALUES)
    assert network.reactant.tolist() == [0, 1]
    assert network.yields[:, :, 0].tolist() == [[0.0, 0.5, 0.125], [0.0, 0.0, 0.25]]
    assert network.gas.tolist() == [[0.375], [0.75]]
    assert network.heat.tolist() == [[0.0], [4e5]]
    assert network.order.tolist() == [[2.0], [1.0]]
    assert network.root_factor.tolist() == [[1e5], [1e5]]
    assert network.activation_temperature[0, 0] == pytest.approx(1000.0)
    assert not network.first_order
    assert not network.plain


@pytest.mark.parametrize(("oxygen_order", "heat"), [(0.0, 0.0), (1.0, -4e5)])
def test_heat_release_takes_the_heat_of_reactions_with_oxygen_only(
    oxygen_order: float, heat: float
) -> None:
    """A heat of reaction that only slabs show has no value while kinetics are fitted."""
    words = {"heat_of_reaction_J_kg": "dh", "heat_of_combustion_J_kg": 2e7}
    matter = material({"1": reaction("A", oxygen_order=oxygen_order, **words)})
    values = VALUES | ({"dh": heat} if oxygen_order else {})
    network = lower_network.lower_network(matter, values, heats=False, oxygen=0.2)
    assert network.combustion.tolist() == [[2e7]]
    assert network.heat.tolist() == [[heat]]
    assert network.glow.tolist() == [[-heat]]


@pytest.mark.parametrize(
    ("reactions", "plain"),
    [
        ({"1": reaction("A", products={"char": 0.1}), "2": reaction("B")}, True),
        ({"1": reaction("A", products={"B": 0.1}), "2": reaction("B")}, False),
        ({"1": reaction("A"), "2": reaction("A")}, False),
        ({"1": reaction("A", products={"B": 0.1, "char": 0.1})}, False),
        ({"1": reaction("A", order=1.5)}, True),
    ],
)
def test_short_cut_is_taken_for_parallel_reactions_only(
    reactions: dict[str, Any], plain: bool
) -> None:
    assert lower_network.lower_network(material(reactions), VALUES).plain is plain


def test_plain_network_knows_its_residue() -> None:
    reactions = {"1": reaction("A", products={"char": 0.1}), "2": reaction("B")}
    network = lower_network.lower_network(material(reactions), VALUES)
    assert network.residue[0] == 2
    assert network.residue_yield.tolist() == [[0.1], [0.0]]


def test_material_without_reactions_has_an_empty_network() -> None:
    network = lower_network.lower_network(material(), VALUES)
    assert network.yields.shape == (0, 3, 1)
    assert network.reactant.size == network.root_factor.size == 0


def test_exposure_by_hand() -> None:
    given = experiment(
        sample={
            "foil": {"thickness_m": 2e-4, "density_kg_m3": 8940.0, "specific_heat_J_kgK": 380.0},
            "emissivity_depth": 3e-5,
        },
        front={"flux_W_m2": "q", "h_W_m2K": "h", "gas_temperature_K": 330.0},
        back={"h_cube_root_W_m2K43": 1.31, "emissivity": 0.9, "wall_temperature_K": 280.0},
    )
    exposure = exposed(given, material())
    assert [n.tolist() for n in exposure.front] == [[0.0], [0.0], [0.0]]
    assert [n.tolist() for n in exposure.back] == [[1.31], [0.0], [0.0]]
    given_over_time = [0.0, 3e4, 12.0, 330.0, 293.15, 0.0, 293.15, 280.0, 0.0, 1.0, 0.0]
    assert exposure.schedule.tolist() == [[[x]] for x in given_over_time]
    assert exposure.back_emissivity == 0.9
    assert exposure.foil_capacity == pytest.approx(679.44)
    assert exposure.back_absorbs
    assert exposure.mixing_depth == 3e-5


def test_sample_without_foil_has_no_foil_capacity() -> None:
    exposure = exposed(experiment(), material())
    assert exposure.foil_capacity == 0.0
    assert not exposure.back_absorbs


def test_flux_table_keeps_its_points() -> None:
    table = {"time_s": [0.0, 30.0, 30.0], "value": [0.0, 0.0, "q"]}
    exposure = exposed(experiment(front={"flux_W_m2": table}), material())
    assert exposure.schedule[TIME].tolist() == [[0.0], [30.0], [30.0]]
    assert exposure.schedule[FLUX].tolist() == [[0.0], [0.0], [3e4]]


def test_tables_of_different_times_meet_at_all_of_them() -> None:
    # h falls from 12 to 6 within 40 s, the flux steps at 20 s, where h is 9.
    front = {
        "flux_W_m2": {"time_s": [0.0, 20.0, 20.0], "value": [0.0, 1e4, "q"]},
        "h_W_m2K": {"time_s": [0.0, 40.0], "value": ["h", 6.0]},
        "h_change_W_m2K": -7.0,
    }
    back = {"gas_temperature_K": {"time_s": [0.0, 10.0], "value": [300.0, 310.0]}}
    exposure = exposed(experiment(front=front, back=back), material())
    rows = {row: exposure.schedule[row, :, 0].tolist() for row in (TIME, FLUX, FRONT_H, BACK_GAS)}
    assert rows == {
        TIME: [0.0, 10.0, 20.0, 20.0, 40.0],
        FLUX: [0.0, 5e3, 1e4, 3e4, 3e4],
        FRONT_H: [5.0, 3.5, 2.0, 2.0, 0.0],
        BACK_GAS: [300.0, 310.0, 310.0, 310.0, 310.0],
    }


@pytest.mark.parametrize(
    ("virgin", "expected"),
    [
        # sqrt(0.2/(1000 2000)) = 3.16e-4 m in 1 s
        ({}, 0.05 * math.sqrt(1e-7)),
        # at 293.15 K: k = 0.2 sqrt(293.15/300), from a table of 5 K to 9e-6
        (
            {"conductivity_W_mK": {"value": 0.2, "exponent": 0.5}},
            0.05 * math.sqrt(1e-7 * math.sqrt(293.15 / 300.0)),
        ),
    ],
)
def test_mixing_depth_is_the_cell_of_fds(virgin: dict[str, Any], expected: float) -> None:
    given = experiment(sample={"emissivity_depth": {"cell_size_factor": 0.05}})
    exposure = exposed(given, material(virgin=virgin))
    assert exposure.mixing_depth == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("sets", [1, 2])
def test_whole_numbers_are_taken_as_floats(sets: int) -> None:
    given, matter = experiment(front={"flux_W_m2": "q", "h_W_m2K": "h"}), material()
    values = VALUES | {"h": 12, "q": 30000}
    arrays = lower.lower_material(matter, values, sets)
    share = lower_experiment.lower_share(given, matter, values, sets)
    exposure = lower_exposure.lower_exposure(given, share, arrays, values, sets)
    for found, exact in ((exposure.schedule[FRONT_H, 0], 12.0), (exposure.schedule[FLUX, 0], 3e4)):
        assert found.dtype == np.float64
        assert found.tolist() == [exact] * sets


def test_exposure_of_numbers_is_lowered_once() -> None:
    given = experiment(front={"flux_W_m2": 3e4, "h_W_m2K": 12.0})
    first, second = exposed(given, material()), exposed(given, material())
    assert first.front is second.front
    named = exposed(experiment(front={"flux_W_m2": "q"}), material())
    assert named.schedule[FLUX].tolist() == [[3e4]]


def test_mixing_depth_follows_the_front_layer() -> None:
    # Half A, half char by mass: volumes 1 and 2 of 3, k = (0.2 + 2 0.4)/3, rho = 2000/3,
    # c = 1500, so k/(rho c) = (1/3)/1e6.
    layers = [
        {"thickness_m": 1e-3, "composition": {"A": 0.5, "char": 0.5}},
        {"thickness_m": 5e-3},
    ]
    given = experiment(sample={"layers": layers, "emissivity_depth": {"cell_size_factor": 1.0}})
    exposure = exposed(given, material())
    assert exposure.mixing_depth == pytest.approx(math.sqrt(1e-6 / 3.0), rel=1e-12)


def cells(given: Gasification, matter: Material, count: int) -> Any:
    arrays = lower.lower_material(matter, VALUES)
    layers = lower_experiment.lower_layers(given, matter, arrays, VALUES)
    mass, empty = lower_experiment.share_out_cells(layers, np.array([count]))
    assert empty.tolist() == [0]
    return mass


LAYERS = [
    {"thickness_m": 1e-3, "composition": {"char": 1.0}},
    {"thickness_m": 3e-3},
]


def test_cells_share_the_mass_of_the_sample() -> None:
    # Density of half A, half char by mass: 1/(0.5/1000 + 0.5/500) = 2000/3 kg/m3.
    matter = material(composition={"A": 0.5, "char": "rest"})
    mass = cells(experiment(), matter, 8)
    assert mass.shape == (8, 3, 1)
    assert mass[0, :, 0].tolist() == pytest.approx([0.25, 0.0, 0.25])
    assert (mass == mass[0]).all()
    assert mass.sum() == pytest.approx(4.0)


def test_layers_share_the_cells_by_thickness() -> None:
    mass = cells(experiment(sample={"layers": LAYERS}), material(), 20)
    assert mass.shape == (20, 3, 1)
    assert mass[:5, :, 0].tolist() == [[0.0, 0.0, pytest.approx(0.1)]] * 5
    assert mass[5:, :, 0].tolist() == [[pytest.approx(0.2), 0.0, 0.0]] * 15


def test_thin_layer_keeps_two_cells() -> None:
    layers = [{"thickness_m": 1e-6, "composition": {"char": 1.0}}, {"thickness_m": 6e-3}]
    mass = cells(experiment(sample={"layers": layers}), material(), 10)
    assert mass.shape == (12, 3, 1)
    assert mass[:2, 2, 0].tolist() == pytest.approx([2.5e-4, 2.5e-4])


def test_set_with_fewer_cells_begins_with_empty_ones() -> None:
    given, matter = experiment(sample={"layers": LAYERS}), material()
    arrays = lower.lower_material(matter, VALUES, 3)
    layers = lower_experiment.lower_layers(given, matter, arrays, VALUES, 3)
    mass, empty = lower_experiment.share_out_cells(layers, np.array([8, 20, 12]))
    assert mass.shape == (20, 3, 3)
    assert empty.tolist() == [12, 0, 8]
    for s, count in enumerate((8, 20, 12)):
        assert not mass[: 20 - count, :, s].any()
        assert np.array_equal(mass[20 - count :, :, s], cells(given, matter, count)[:, :, 0])


def test_number_of_cells_is_made_a_multiple_by_empty_ones() -> None:
    given, matter = experiment(sample={"layers": LAYERS}), material()
    arrays = lower.lower_material(matter, VALUES, 2)
    layers = lower_experiment.lower_layers(given, matter, arrays, VALUES, 2)
    mass, empty = lower_experiment.share_out_cells(layers, np.array([8, 17]), 8)
    assert mass.shape == (24, 3, 2)
    assert empty.tolist() == [16, 7]
    for s, count in enumerate((8, 17)):
        assert not mass[: 24 - count, :, s].any()
        assert np.array_equal(mass[24 - count :, :, s], cells(given, matter, count)[:, :, 0])


# Many sets at once

PER_SET = {
    "rho_c": np.array([400.0, 500.0, 600.0]),
    "q": np.array([2e4, 3e4, 4e4]),
    "k": np.array([0.1, 0.2, 0.3]),
    "n": np.array([0.7, 0.5, 2.0]),
    "order": np.array([1.0, 2.0, 1.0]),
    "rate": np.array([2e-3, 3e-3, 5e-3]),
    "x": np.array([0.0, 1e-3, -1e-3]),
    "length": np.array([0.0, 1e-3, 5e-4]),
    "T0": np.array([290.0, 301.0, 312.0]),
    "size": np.array([4e-3, 5e-3, 6e-3]),
    "share": np.array([0.1, 0.2, 0.3]),
    "E": np.array([1.4e5, 1.5e5, 1.6e5]),
}
VARIED = {
    "conductivity_W_mK": {"value": "k", "exponent": "n"},
    "specific_heat_J_kgK": {"of": 2000.0, "slope_1_K": "x", "step": "q", "peak_area": "q"},
    "expansion": {"value": 1.0, "slope_1_K": "x"},
    "emissivity": "share",
}
TABLE = {"temperature_K": (300.0, 400.0), "value": ("k", 0.3), "factor": "x"}
REACTIONS = {
    "given": reaction("A", products={"B": "share"}, order="order", E_J_mol="E"),
    "at_a_temperature": {
        "reactant": "B",
        "E_J_mol": "E",
        "reference_temperature_K": 600.0,
        "reference_rate_1_s": "rate",
        "heat_of_reaction_J_kg": "q",
    },
}


def everything(values: Any, sets: int) -> list[Any]:
    """Return all that is lowered of a case in which every number differs from set to set."""
    matter = material(REACTIONS, {"A": "rest", "char": "share"}, VARIED)
    front = {"flux_W_m2": {"time_s": [0.0, 9.0], "value": ["q", 0.0]}, "drift_1_s": "x"}
    layers = [{"thickness_m": "size"}, {"thickness_m": 1e-3, "composition": {"char": 1.0}}]
    sample = {"layers": layers, "absorption_length_m": "length", "initial_temperature_K": "T0"}
    given = experiment(
        sample=sample | {"emissivity_depth": {"cell_size_factor": "share"}},
        front=front,
        back={"h_W_m2K": "T0", "loss_factor": "share"},
    )
    arrays = lower.lower_material(matter, values, sets, values["length"])
    share = lower_experiment.lower_share(given, matter, values, sets)
    return [
        *arrays,
        *lower_network.lower_network(matter, values, sets),
        *lower_exposure.lower_exposure(given, share, arrays, values, sets),
        *(
            part
            for layer in lower_experiment.lower_layers(given, matter, arrays, values, sets)
            for part in layer
        ),
        share,
        lower_property.property_table(Table(**TABLE), values, sets),
    ]


def flat(parts: Any) -> list[Any]:
    """Return the arrays of floats in nested tuples."""
    if isinstance(parts, list | tuple):
        return [array for part in parts for array in flat(part)]
    return [parts] if isinstance(parts, np.ndarray) and parts.dtype == float else []


@pytest.mark.parametrize("s", range(3))
def test_sets_lowered_at_once_have_the_bits_of_each_alone(s: int) -> None:
    at_once = flat(everything(PER_SET, 3))
    alone = flat(everything({name: float(value[s]) for name, value in PER_SET.items()}, 1))
    assert len(at_once) == len(alone) >= 36
    for many, one in zip(at_once, alone, strict=True):
        assert many.shape == (*one.shape[:-1], 3)
        assert np.array_equal(many[..., s], one[..., 0])
    differ = [many for many in at_once if (many[..., :1] != many).any()]
    assert len(differ) >= 20


def test_network_is_first_order_where_every_set_is() -> None:
    def network(order: Any) -> Any:
        given = material({"1": reaction("A", order="n")})
        return lower_network.lower_network(given, {"n": np.array(order)}, 2)

    assert network([1.0, 1.0]).first_order
    assert not network([1.0, 2.0]).first_order
