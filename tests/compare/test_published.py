"""Published parameter sets beside the measured tests of a study."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

import pyrofit as pf
from pyrofit.cli import main
from pyrofit.data.fetch import FOLDER_VARIABLE
from pyrofit.errors import DataError, StudyError
from pyrofit.stages.measurements import computed
from pyrofit_compare.compute import REPEATS
from pyrofit_compare.published import (
    LIBRARY,
    MEAN,
    chosen_sets,
    errors_of_published,
    means_by_signal,
    published,
)
from pyrofit_exchange.macfp.material import strict_of
from pyrofit_exchange.macfp.numeric import numeric_material
from pyrofit_explore.model import pose_model
from pyrofit_explore.run import PublishedSets

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
TRUTH = yaml.safe_load(SMOKE.read_text())["synthetic"]["truth"]
UNITS = {"mlr": "kg/m2/s", "mass_fraction": "-"}
ABOUT = {"Material": "polymer", "Lab": "A", "Calibration": []}


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data base of three sets: the truth, one of half the density, one of kinetics alone."""
    folder = tmp_path_factory.mktemp("base") / "Polymer" / "Material_Properties" / "2024"
    folder.mkdir(parents=True)
    study = pf.read_study(SMOKE)
    values = {n: v * study.parameters[n].factor for n, v in TRUTH.items()}
    material, _ = numeric_material(study.material, values)
    true = strict_of(material, ABOUT)
    (folder / "Polymer_A.json").write_text(true.text())
    component = material.components["polymer"].model_copy(update={"density_kg_m3": 600.0})
    components = {**material.components, "polymer": component}
    light = strict_of(material.model_copy(update={"components": components}), ABOUT)
    (folder / "Polymer_B.json").write_text(light.text())
    whole = json.loads(true.text())
    kinetics = {key: whole[key] for key in (*ABOUT, "Composition", "Kinetics")}
    (folder / "Polymer_C.json").write_text(json.dumps(kinetics))
    return folder.parents[2]


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> pf.Study:
    """The study with a slab and a TGA that are read from files, as the truth has them."""
    folder = tmp_path_factory.mktemp("measured")
    study = pf.read_study(SMOKE)
    curves = pf.simulate(study, TRUTH, experiments=["slab_60", "tga_20K"]).series
    keys = yaml.safe_load(SMOKE.read_text())["experiments"]
    own = {}
    for name, signal in (("slab_60", "mlr"), ("tga_20K", "mass_fraction")):
        frame = curves[name, signal]
        path = folder / f"{name}.csv"
        given = {"time": frame["time_s"], "value": frame.iloc[:, -1]}
        if "temperature_K" in frame:
            given["temperature"] = frame["temperature_K"]
        pd.DataFrame(given).to_csv(path, index=False)
        columns = {role: role for role in given}
        units = {"time": "s", "temperature": "K", "value": UNITS[signal]}
        before = keys[name]["signals"][signal]
        kept = {key: before[key] for key in ("average_s",) if key in before}
        read = {**kept, "columns": columns, "units": {role: units[role] for role in given}}
        own[f"own_{name}"] = {
            **keys[name],
            "signals": {signal: {"file": str(path), **read}},
        }
    return pf.read_study(SMOKE, experiments=own)


def test_sets_are_found_by_parts_of_their_names(base: Path) -> None:
    sets, left = published(base)
    assert list(sets) == ["Polymer_A", "Polymer_B", "Polymer_C"]
    assert left == []
    assert list(chosen_sets(sets, ["_b"])) == ["Polymer_B"]
    assert list(chosen_sets(sets, [])) == list(sets)
    with pytest.raises(DataError, match=r"no parameter set is named 'Polymer_AB'\. Did you mean"):
        chosen_sets(sets, ["Polymer_AB"])


def test_the_set_of_the_truth_predicts_best(base: Path, measured: pf.Study) -> None:
    sets, _ = published(base)
    found, remarks = errors_of_published(measured, sets)
    assert list(found.index) == ["Polymer_A", "Polymer_B", "Polymer_C", REPEATS]
    assert found.loc["Polymer_A"].max() < 1e-3
    slab, tga = ("own_slab_60", "mlr"), ("own_tga_20K", "mass_fraction")
    assert found.loc["Polymer_B", slab] > 0.1
    assert np.isnan(found.loc["Polymer_C", slab])
    assert found.loc["Polymer_C", tga] < 1e-3
    assert any("the measurement is computed" in remark for remark in remarks)
    table = means_by_signal(found)
    assert list(table.columns) == [MEAN, "mlr", "mass_fraction"]
    assert table.loc["Polymer_B", MEAN] == pytest.approx(found.loc["Polymer_B"].mean())


def test_the_explorer_draws_the_curves_of_a_set(
    base: Path, measured: pf.Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(base))
    own = {"own_slab_60": ["mlr"], "own_tga_20K": ["mass_fraction"]}
    data = dict(pf.read_data(measured, own).series)
    # The computed tests are fitted, so the problem holds them as well.
    data |= computed(measured, fast=True)
    model = pose_model(measured, data)
    values = {n: v * measured.parameters[n].factor for n, v in TRUTH.items()}
    sets = PublishedSets()
    true, mine = sets.simulate(model, "Polymer_A", values), model.simulate(values)
    light, kinetics = (sets.simulate(model, f"Polymer_{n}", values) for n in "BC")
    at = {key: i for i, key in enumerate(model.signals)}
    slab, tga = at["own_slab_60", "mlr"], at["own_tga_20K", "mass_fraction"]
    for i in (slab, tga):
        np.testing.assert_allclose(true.models[i], mine.models[i], atol=1e-3 * mine.models[i].max())
    assert np.ptp(light.models[slab] - mine.models[slab]) > 1e-3
    assert np.isnan(kinetics.models[slab]).all()
    np.testing.assert_allclose(kinetics.models[tga], mine.models[tga], atol=1e-3)
    with pytest.raises(StudyError, match=r"no published set 'Polymer_D'\. Did you mean"):
        sets.simulate(model, "Polymer_D", values)


def test_folder_without_sets_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["materials", "--folder", str(tmp_path)]) == 2
    assert (
        f"{tmp_path}: no parameter sets. Give a copy of the MaCFP data base"
        in capsys.readouterr().err
    )


def test_each_shipped_material_predicts_a_slab_and_a_tga(measured: pf.Study) -> None:
    sets, left = published(LIBRARY)
    assert not left
    assert len(sets) == 12
    assert {one.strict.laboratory for one in sets.values()} == {
        "University of Maryland, FDS validation",
        "FAA, FDS validation",
    }
    found, _ = errors_of_published(measured, sets)
    assert set(found.index) == {*sets, REPEATS}
    assert found.drop(index=REPEATS).notna().all(axis=None)


def test_shipped_material_has_the_numbers_of_the_deck_of_fds() -> None:
    one = published(LIBRARY)[0]["FDS_PET"]
    # FDS has another gas constant in its last digits.
    np.testing.assert_allclose(one.strict.kinetics.A, (1.5e36, 1.6e15, 3.53e4), rtol=2e-4)
    assert one.strict.kinetics.yields == (0.999999, 0.18, 0.72)
    assert any("ADJUST_H" in remark for remark in one.remarks)


def test_data_base_is_not_needed(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "none"))
    assert main(["materials", "FDS_P"]) == 0
    said = capsys.readouterr().out
    assert "FDS_PMMA" in said
    assert "the sets of the MaCFP data base are not here" in said


def test_folder_of_own_files_is_read(base: Path, tmp_path: Path) -> None:
    (tmp_path / "mine.fds").write_text((LIBRARY / "FDS_PC.fds").read_text())
    (tmp_path / "bad.fds").write_text("&SURF ID='a' /")
    set_file = next(base.glob("*/Material_Properties/**/Polymer_A.json"))
    (tmp_path / "theirs.json").write_text(set_file.read_text())
    sets, left = published(tmp_path)
    assert list(sets) == ["theirs", "mine"]
    assert len(left) == 1
    assert "bad.fds: it has no MATL line" in left[0]


def test_command_lists_shows_and_writes(
    base: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "sets.csv"
    assert main(["materials", "--folder", str(base), "--csv", str(table)]) == 0
    assert "slab and kinetics" in capsys.readouterr().out
    assert pd.read_csv(table)["describes"].tolist()[-1] == "kinetics"
    assert main(["materials", "Polymer_A", "--folder", str(base), "--show"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("# Polymer_A: polymer, A")
    assert "components" in yaml.safe_load(said)["material"]
