"""A submission of a study: every file that the workshops ask for, and what they hold."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from pyrofit.cli import main
from pyrofit.config import read_study
from pyrofit_exchange.macfp.numeric import numeric_material
from pyrofit_exchange.macfp.predict import WOOD_CASES, material, simulate_case
from pyrofit_exchange.macfp.read import read_set
from pyrofit_exchange.macfp.readme import absent_parts
from pyrofit_exchange.macfp.schema import Composition, Kinetics, StrictSet

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"


@pytest.fixture(scope="module")
def submission(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("submission")
    given = ["macfp", "submit", str(SMOKE), "--institute", "Own", "--set", "truth"]
    assert main([*given, "--like", "slab_60", "--out", str(folder)]) == 0
    return folder


def test_parameter_set_is_strict_and_holds_the_truth(submission: Path) -> None:
    found = read_set(submission / "MaCFP_PMMA_Own.json")
    assert found.is_strict
    conductivity = found.strict.as_json()["Transport"]["Conductivity"]
    assert conductivity == {"Form": "Single Value", "Value": 0.2}  # of both components
    heat = found.strict.as_json()["Thermodynamics"]["Heat of Pyrolysis"]
    assert heat == {"Form": "Single Value", "Value": 8e5}


def test_predictions_are_those_of_the_submitted_set(submission: Path) -> None:
    of = material(read_set(submission / "MaCFP_PMMA_Own.json").strict)
    case = WOOD_CASES[2]
    table = pd.read_csv(submission / "MaCFP-4" / "Own_PMMA_GASIFICATION_q30_6mm.csv")
    assert list(table) == ["Time (s)", "Mass (g)", "MLR (g/m2/s)", "T Back (K)", "T Top (K)"]
    assert len(table) == 801
    curves = simulate_case(of, case)
    assert np.allclose(table["MLR (g/m2/s)"], 1e3 * curves.mlr_kg_m2_s, atol=2e-3)
    # The mass falls by what the rate says: both columns tell the same.
    lost = np.cumsum(table["MLR (g/m2/s)"]) * 0.01
    assert np.abs(table["Mass (g)"].iloc[0] - lost - table["Mass (g)"]).max() < 0.02


def test_all_files_of_both_workshops_have_their_rows_and_units(submission: Path) -> None:
    rows = {p.name: len(pd.read_csv(p)) for p in (submission / "MaCFP-4").iterdir()}
    assert rows == {
        "Own_PMMA_STA_N2_10K.csv": 1561,
        "Own_PMMA_STA_N2_100K.csv": 1561,
        "Own_PMMA_GASIFICATION_q10_6mm.csv": 1501,
        "Own_PMMA_GASIFICATION_q10_18mm.csv": 4201,
        "Own_PMMA_GASIFICATION_q30_6mm.csv": 801,
        "Own_PMMA_GASIFICATION_q30_18mm.csv": 2401,
        "Own_PMMA_GASIFICATION_q60_6mm.csv": 601,
        "Own_PMMA_GASIFICATION_q60_18mm.csv": 1201,
    }
    heads = {p.name: p.read_text().splitlines()[:2] for p in (submission / "MaCFP-3").iterdir()}
    assert len(heads) == 6
    assert heads["Own_Gasification_q50_MLR.csv"] == ["Time,MLR", "[s],[g/m2/s]"]
    assert heads["Own_Gasification_q25_Temp.csv"] == ["Time,T_back_1", "[s],[K]"]


def test_proof_of_calibration_differs_by_the_noise(submission: Path) -> None:
    table = pd.read_csv(submission / "proof_of_calibration" / "Own_tga_5K_mass_fraction.csv")
    assert list(table) == ["Time (s)", "Temperature (K)", "Mass (mg)"]
    readme = (submission / "README.md").read_text(encoding="utf-8")
    (line,) = [x for x in readme.splitlines() if x.startswith("| tga_5K | mass_fraction")]
    assert float(line.split("|")[3].split()[0]) == pytest.approx(0.003, rel=0.2)
    assert "| reference temperature of the reaction | 605 | K | 560 to 660 |" in readme
    assert "Held out, used by no cost: slab_60." in readme


def test_water_of_other_samples_is_told_to_be_absent() -> None:
    kinetics = Kinetics.model_construct(reactants=((3,), (1,)), products=((0,), (2,)))
    composition = Composition.model_construct(
        names=("wood", "char", "water"), fractions=(1.0, 0.0, 0.0)
    )
    strict = StrictSet.model_construct(composition=composition, kinetics=kinetics)
    assert absent_parts(strict) == ["water"]


def test_parameters_with_a_given_value_are_told_so(tmp_path: Path) -> None:
    text = SMOKE.read_text(encoding="utf-8")
    text = text.replace(
        "rho: {unit: kg/m3, lower: 900, upper: 1500,", "rho: {unit: kg/m3, value: 1180,"
    )
    text = text.replace("estimate: [rho, k,", "estimate: [k,").replace("rho: 1190, ", "")
    path = tmp_path / "known.yaml"
    path.write_text(text, encoding="utf-8")
    given = ["macfp", "submit", str(path), "--institute", "Own", "--set", "truth", "--form", "3"]
    assert main([*given, "--out", str(tmp_path / "out")]) == 0
    readme = (tmp_path / "out" / "README.md").read_text(encoding="utf-8")
    assert "| density | 1180 | kg/m3 | given |" in readme


def test_rules_of_the_guidelines_are_minded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["macfp", "submit", str(SMOKE), "--institute", "Own", "--set", "truth"]
    assert main([*given, "--form", "3", "--out", str(tmp_path)]) == 0
    assert "are ideal; give the apparatus with --like" in capsys.readouterr().out
    assert main([*given, "--like", "slab_6", "--out", str(tmp_path)]) == 2
    assert "there is no experiment 'slab_6'" in capsys.readouterr().err


def test_values_take_the_place_of_parameters() -> None:
    study = read_study(SMOKE)
    of, notes = numeric_material(study.material, study.true_values())
    assert notes == []
    assert of.components["polymer"].specific_heat_J_kgK == 2100.0
    assert of.reactions["pyrolysis"].E_J_mol == 190e3
    assert of.reactions["pyrolysis"].reactant == "polymer"
