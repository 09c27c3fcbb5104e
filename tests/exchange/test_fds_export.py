"""What `pyrofit export fds` writes of a study."""

import json
from pathlib import Path

import pytest

from pyrofit.cli import main
from pyrofit.config import as_yaml, read_mapping, read_study
from pyrofit_exchange.fds.parse import read_namelists

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("with a space")
    given = ["export", "fds", str(ROOT / "config" / "smoke.yaml"), "--set", "truth"]
    assert main([*given, "--fds-version", "6.11.1", "--out", str(out)]) == 0
    return out


def test_every_file_of_the_summary_is_there_and_can_be_read(folder: Path) -> None:
    summary = json.loads((folder / "export.json").read_text())
    assert summary["fds"] == "6.8+"
    assert summary["set"] == "truth"
    for deck in summary["decks"]:
        path = folder / deck["file"]
        groups = [group for group, _, _ in read_namelists(path.read_text(), path.name)]
        assert groups[0] == "HEAD"
        assert groups[-1] == "TAIL"
        assert (folder / f"{path.stem}_pyrofit.csv").exists()


def test_the_include_file_has_no_head_and_names_every_parameter(folder: Path) -> None:
    text = (folder / "material.fds").read_text()
    read = list(read_namelists(text, "material.fds"))
    assert {group for group, _, _ in read} <= {"REAC", "MATL", "RAMP", "SURF"}
    (gas,) = [keys["FUEL"] for group, keys, _ in read if group == "REAC"]
    for group, keys, _ in read:
        if group == "MATL" and "N_REACTIONS" in keys:
            assert keys["SPEC_ID(1,1)"] == gas
    for name in json.loads((folder / "export.json").read_text())["values_SI"]:
        assert f"  {name} = " in text
    text.encode("ascii")


def test_the_error_of_the_default_grid_is_that_of_the_measured_material(folder: Path) -> None:
    text = (folder / "material.fds").read_text()
    assert "for PMMA of 6 mm" in text[text.index("34 % at 60") :]


def test_an_unknown_set_is_refused_with_the_way_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = str(ROOT / "config" / "twin.yaml")
    assert main(["export", "fds", study, "--results", str(tmp_path)]) == 2
    assert "--set truth" in capsys.readouterr().err


def test_a_set_without_a_value_names_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "values.json"
    path.write_text("{}")
    study = str(ROOT / "config" / "smoke.yaml")
    assert main(["export", "fds", study, "--set", str(path), "--out", str(tmp_path)]) == 2
    assert "has no value for" in capsys.readouterr().err


def test_an_extended_study_takes_the_values_that_the_diagnosis_left_beside_it(
    tmp_path: Path,
) -> None:
    study = read_study(ROOT / "config" / "smoke.yaml")
    given = read_mapping(ROOT / "config" / "smoke.yaml")
    given |= {"name": "smoke_extended", "effects": {"k_T": {"slope_1_K": -0.001}}}
    path = tmp_path / "diagnosis" / "extended.yaml"
    path.parent.mkdir()
    path.write_text(as_yaml(given, ""))
    truth = study.synthetic.truth if study.synthetic else {}
    about = {"low": 0.0, "high": 1.0, "at_limit": False}
    of = {n: {"value": v, "unit": study.parameters[n].unit, **about} for n, v in truth.items()}
    found = {"extended": {"parameters": of}}
    (path.parent / "diagnosis.json").write_text(json.dumps(found))
    out = tmp_path / "fds"
    assert main(["export", "fds", str(path), "--results", str(tmp_path), "--out", str(out)]) == 0
    summary = json.loads((out / "export.json").read_text())
    assert summary["set"] == "diagnosis"
    assert summary["effects"] == {"k_T": {"slope_1_K": -0.001}}
    for name, value in truth.items():
        assert summary["values_SI"][name] == pytest.approx(value * study.parameters[name].factor)
    text = (out / "material.fds").read_text()
    assert "CONDUCTIVITY_RAMP" in text
    assert "effect of the model: k_T: slope_1_K -0.001" in text
    assert "95 % interval 0 to 1" in text
