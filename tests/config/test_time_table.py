"""Boundary conditions over time in a study, from its own keys and from files."""

from pathlib import Path
from typing import Any

import pytest
from changed_study import changed

from pyrofit.config import as_study
from pyrofit.errors import StudyError

FLUX = "experiments.slab_25.front.flux_W_m2"
H = "experiments.slab_25.front.h_W_m2K"
GAS = "experiments.slab_25.back.gas_temperature_K"


def described(path: str, value: object, folder: Path = Path()) -> Any:
    """What the study holds at the path once the value stands there."""
    part: Any = as_study(changed(path, value), str(folder / "mine.yaml"))
    for key in path.split("."):
        part = part[key] if isinstance(part, dict) else getattr(part, key)
    return part


def complaint(path: str, value: object, folder: Path = Path()) -> str:
    with pytest.raises(StudyError) as caught:
        described(path, value, folder)
    return str(caught.value)


@pytest.mark.parametrize("path", [FLUX, H, GAS])
def test_every_boundary_condition_may_follow_a_table(path: str) -> None:
    table = described(path, {"time_s": [0, 60, 60], "value": [400, 300, 350]})
    assert (table.time_s, table.value) == ((0.0, 60.0, 60.0), (400.0, 300.0, 350.0))


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (FLUX, {"time_s": [0, 9, 3], "value": [1, 1, 1]}, "must not decrease; sort the points"),
        (FLUX, {"time_s": [0, 9], "value": [1]}, "same length, at least 1; they have 2 and 1"),
        (FLUX, {"time_s": [3, 9], "value": [1, 1]}, "must start at 0, the start of the test; add"),
        (FLUX, {"time_s": [0, 9], "value": [1, -1]}, f"{FLUX}.value.1: -1 must not be negative"),
        (H, {"time_s": [0, 9], "value": [-4, 4]}, f"{H}.value.0: -4 must not be negative"),
        (GAS, {"time_s": [0, 9], "value": [20, 30]}, f"{GAS}.value.0: 20 must be at least 150"),
        (H, {"time_s": [0, 9], "value": ["nobody", 4]}, f"{H}.value.0: unknown parameter 'nobody'"),
        (H, {"time_s": [0, 9], "h": [3, 4]}, "unknown key 'h'"),
    ],
)
def test_bad_table_is_told_with_its_key_its_rule_and_the_way_out(
    path: str, value: object, said: str
) -> None:
    assert said in complaint(path, value)


def test_table_may_be_a_file_beside_the_study(tmp_path: Path) -> None:
    text = "Time (min),Gauge (kW/m2),T (degC)\n0.5,20,20\n1,30,50\n1,25,80\n"
    (tmp_path / "heater.csv").write_text(text)
    columns = {"value": "Gauge"}
    flux = described(FLUX, {"file": "heater.csv", "columns": columns}, tmp_path)
    assert flux.time_s == (0.0, 30.0, 60.0, 60.0)
    assert flux.value == (2e4, 2e4, 3e4, 2.5e4)
    gas = described(GAS, {"file": "heater.csv", "columns": {"value": "T"}}, tmp_path)
    assert gas.value == (293.15, 293.15, 323.15, 353.15)


@pytest.mark.parametrize(
    ("text", "given", "said"),
    [
        ("Time (s),q (kW/m2)\n5,1\n3,2\n", {}, "column 'Time': times must not decrease"),
        ("Time (s),q (kW/m2)\n-5,1\n3,2\n", {}, "not begin before 0, the start of the test"),
        ("Time (s),q\n0,1\n3,2\n", {}, "no unit of the value"),
        ("Time (s),q (K)\n0,1\n3,2\n", {}, "unknown unit 'K' of the value"),
        ("Time (s),q (kW/m2),p (kW/m2)\n0,1,1\n", {}, "2 columns may be the value; name"),
        ("Time (s),q (kW/m2)\n0,1\n", {"columns": {"value": "Q2"}}, "there is no column 'Q2'"),
        ("Time (s),q (kW/m2)\n0,1\n", {"columns": {"flux": "q"}}, "unknown role 'flux'"),
        ("Time (s),q (kW/m2)\n0,1\n", {"column": {"value": "q"}}, "unknown key 'column'"),
        ("Time (s),q (kW/m2)\n0,-1\n3,1\n", {}, "value.0: -1000 must not be negative"),
    ],
)
def test_bad_file_of_a_table_is_told_with_its_place(
    text: str, given: dict[str, Any], said: str, tmp_path: Path
) -> None:
    (tmp_path / "q.csv").write_text(text)
    message = complaint(FLUX, {"file": "q.csv", **given}, tmp_path)
    assert said in message
    assert FLUX in message


BACKING = "experiments.slab_25.sample.backing"


@pytest.mark.parametrize(
    ("layer", "changes", "said"),
    [
        ({"component": "boar"}, {}, f"{BACKING}.0.component: unknown component 'boar'. Did you"),
        ({"component": "polymer"}, {}, f"{BACKING}.0.component: 'polymer' reacts; a layer behind"),
        ({"component": "board"}, {"expansion": 2.0}, "components.board.expansion: a layer behind"),
        ({"component": "board", "thickness_m": 25.0}, {}, "0.thickness_m: 25 must be at most 0.5"),
    ],
)
def test_bad_layer_behind_the_sample_is_told(
    layer: dict[str, Any], changes: dict[str, Any], said: str
) -> None:
    body = {"density_kg_m3": 300, "conductivity_W_mK": 0.1, "specific_heat_J_kgK": 900, **changes}
    study = changed("material.components.board", body)
    study = changed(BACKING, [{"thickness_m": 0.02, **layer}], study)
    with pytest.raises(StudyError) as caught:
        as_study(study, "mine.yaml")
    assert said in str(caught.value)


ADHESIVE = "experiments.slab_25.sample.adhesive"


@pytest.mark.parametrize(
    ("glue", "said"),
    [
        (
            {"component": "polymr"},
            f"{ADHESIVE}.component: unknown component 'polymr'. Did you mean",
        ),
        ({"thickness_m": -1e-4}, f"{ADHESIVE}.thickness_m: -0.0001 must not be negative"),
        ({"thickness_m": 0.6}, f"{ADHESIVE}.thickness_m: 0.6 must be at most 0.5"),
    ],
)
def test_bad_adhesive_is_told(glue: dict[str, Any], said: str) -> None:
    study = changed(ADHESIVE, {"component": "polymer", "thickness_m": 1e-4, **glue})
    with pytest.raises(StudyError) as caught:
        as_study(study, "mine.yaml")
    assert said in str(caught.value)


def test_missing_file_of_a_table_is_told(tmp_path: Path) -> None:
    assert f"{FLUX}: " in complaint(FLUX, {"file": "q.csv"}, tmp_path)
    assert "there is no such file" in complaint(FLUX, {"file": "q.csv"}, tmp_path)
