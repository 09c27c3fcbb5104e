"""Files for Gpyro of layered slabs: their bodies, and the curve that Gpyro makes of one."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from pyrofit.experiments import Gasification
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_gasification
from pyrofit.solver.curves import Request
from pyrofit_exchange.fds.layers import FdsLayer
from pyrofit_exchange.fds.namelists import write_all
from pyrofit_exchange.fds.parse import read_namelists
from pyrofit_exchange.fds.predicted import predict_slab
from pyrofit_exchange.gpyro.data import Data, slab_data
from pyrofit_exchange.gpyro.grid import MOST, grid_of

CURVE = Path(__file__).parents[1] / "stored" / "gpyro" / "layers_40.csv"
FOIL = {"thickness_m": 1e-4, "density_kg_m3": 8940, "specific_heat_J_kgK": 380}


def component(density: float, k: float, c: float) -> dict[str, float]:
    return {
        "density_kg_m3": density,
        "conductivity_W_mK": k,
        "specific_heat_J_kgK": c,
        "emissivity": 0.9,
    }


def material(char_heat: float = 1200.0, board_heat: float = 1000.0) -> Material:
    wood = {
        "reactant": "wood",
        "A_1_s": 1e-3 * math.exp(180e3 / 8.314462618 / 600.0),
        "E_J_mol": 180e3,
        "heat_of_reaction_J_kg": 3e5,
        "products": {"char": 0.2},
    }
    return Material.model_validate(
        {
            "components": {
                "wood": component(500.0, 0.2, 1500.0),
                "char": component(100.0, 0.1, char_heat),
                "board": component(800.0, 0.15, board_heat),
            },
            "reactions": {"charring": wood},
            "composition": {"wood": 1.0},
        }
    )


def slab(board_m: float = 0.008, **sample: Any) -> Gasification:
    back = {"h_W_m2K": 4.0, "emissivity": 0.7}
    walls = {"gas_temperature_K": 300.0, "wall_temperature_K": 300.0}
    layered = [{"component": "board", "thickness_m": board_m}] if board_m else []
    return Gasification.model_validate(
        {
            "kind": "gasification",
            "sample": {
                "layers": [{"thickness_m": 0.004}],
                "backing": layered,
                "initial_temperature_K": 300.0,
                **sample,
            },
            "front": {"flux_W_m2": 40000.0, "h_W_m2K": 10.0, **walls},
            "back": {**back, **walls},
        }
    )


def written(of: Gasification, matter: Material) -> tuple[Data, dict[str, dict[str, Any]]]:
    predicted = predict_slab(of, matter, {}, Accuracy())
    data = slab_data("layers", of, matter, {}, predicted)
    found = read_namelists(write_all(data.namelists), "layers.data")
    return data, {
        group.removeprefix("GPYRO_"): {key: value[0] for key, value in of.items()}
        for group, of, _ in found
    }


def test_layers_are_one_body_and_the_sample_is_in_front() -> None:
    _, keys = written(slab(), material())
    geometry, general = keys["GEOM"], keys["GENERAL"]
    assert general["GEOMETRY_IS_UPSIDE_DOWN"] is False  # else Gpyro counts Z from the back
    assert geometry["NOBST"] == keys["IC"]["NIC"] == 2
    assert geometry["Z1(1)"] == 0.0
    assert geometry["Z1(2)"] == pytest.approx(0.004, rel=5e-3)
    assert geometry["Z2(1)"] == geometry["Z2(2)"] == geometry["ZDIM(1)"] == pytest.approx(0.012)
    order = {keys["SPROPS"][f"NAME({n})"]: n for n in (1, 2, 3)}
    assert keys["IC"][f"YI0(1,{order['wood']})"] == keys["IC"][f"YI0(2,{order['board']})"] == 1.0


@pytest.mark.parametrize(("char", "board", "corrects"), [(1500, 1500, False), (1500, 900, True)])
def test_gpyro_conducts_along_temperature_where_specific_heats_differ(
    char: float, board: float, corrects: bool
) -> None:
    _, keys = written(slab(), material(char, board))
    assert keys["GENERAL"]["SHYI_CORRECTION"] is corrects


def test_the_foil_is_the_half_cell_at_the_back_with_its_heat_capacity() -> None:
    _, keys = written(slab(foil=FOIL), material())
    geometry, species = keys["GEOM"], keys["SPROPS"]
    dz = geometry["ZDIM(1)"] / (geometry["NCELLZ(1)"] - 1)
    last = int(species["NSSPEC"])
    assert species[f"NAME({last})"] == "foil"
    assert geometry["ZDIM(1)"] - geometry["Z1(3)"] == pytest.approx(0.5 * dz)
    assert geometry["Z1(3)"] == pytest.approx(0.012)
    heat = species[f"R0({last})"] * species[f"C0({last})"] * 0.5 * dz
    assert heat == pytest.approx(1e-4 * 8940 * 380)
    assert species[f"EMIS({last})"] == 0.7


@pytest.mark.parametrize("heat", [0.0, 1800.0])
def test_gas_takes_up_the_heat_that_the_study_gives(heat: float) -> None:
    data, keys = written(slab(gas_specific_heat_J_kgK=heat), material())
    assert keys["GPROPS"]["CPG"] == heat
    assert not [r for r in data.remarks if "gas_specific_heat" in r.what]


def test_a_layer_thinner_than_two_cells_is_left_out_by_name() -> None:
    data, keys = written(slab(board_m=5e-6), material())
    (remark,) = [r for r in data.remarks if "layer of" in r.what]
    assert remark.kind == "left out"
    assert "5e-06 m of board" in remark.what
    assert keys["GEOM"]["NOBST"] == 1


@pytest.mark.parametrize(
    "sizes", [[0.004, 0.008], [0.0058], [0.001, 1.3e-4, 0.025], [0.0254, 0.023], [1e-3, 2e-3, 3e-3]]
)
@pytest.mark.parametrize("has_foil", [False, True])
def test_layers_end_halfway_between_nodes(sizes: list[float], has_foil: bool) -> None:
    grid = grid_of([FdsLayer({"a": 1.0}, size) for size in sizes], has_foil)
    assert grid.nodes <= MOST
    dz = grid.depth_m / (grid.nodes - 1)
    inner = np.array(grid.fronts_m[1:])
    assert np.allclose(inner / dz % 1.0, 0.5)
    bounds = [*grid.fronts_m, grid.depth_m]
    kept = np.diff(bounds)[: len(sizes)]
    assert np.max(np.abs(kept / np.array(sizes) - 1.0)) == pytest.approx(grid.worst, abs=1e-9)
    assert grid.worst < 0.05


def test_gpyro_follows_pyrofit_through_two_layers() -> None:
    curve = pd.read_csv(CURVE, comment="#")
    time = curve["time_s"].to_numpy()
    of = slab()
    of = of.model_copy(update={"back": of.back.model_copy(update={"emissivity": 0.9})})
    names = ("mlr", "front_temperature", "back_temperature")
    found = simulate_gasification(of, material(), {}, dict.fromkeys(names, Request(time))).signals
    gap = {
        name: float(np.sqrt(np.mean((found[name] - curve[column].to_numpy()) ** 2)))
        for name, column in zip(names, curve.columns[1:], strict=True)
    }
    assert gap["mlr"] < 0.005 * curve["mlr_kg_m2_s"].mean()
    assert gap["front_temperature"] < 0.5
    assert gap["back_temperature"] < 0.5
