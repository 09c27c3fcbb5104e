"""What an archive must leave out, and what it refuses."""

import hashlib
import importlib.metadata
import json
import zipfile
from pathlib import Path

import pytest

from pyrofit import cli
from pyrofit.archive import write_archive
from pyrofit.archive_crate import WORKFLOW
from pyrofit.config import Study, as_study, digest, read_mapping, read_study
from pyrofit.data.fetch import COMMIT
from pyrofit.errors import DataError
from pyrofit.plugins import use_plugins
from pyrofit.provenance import STUDY, source_fingerprint
from pyrofit.results.dependencies import code
from pyrofit.results.files import Results

ROOT = Path(__file__).parents[3]
PMMA = ROOT / "config" / "pmma.yaml"
CURVES = (
    "experiment,signal,set,time_s,simulated,measured\n"
    "capa_25,mlr,RMSE,2.5,0.0010000000000000002,0.777\n"
    'capa_25,back_temperature,RMSE,2.5,"300.1",777.7\n'
)


def results_of(study: Study, root: Path) -> Results:
    """Write what an archive needs of results."""
    results = Results(root)
    results.validation("curves.csv").parent.mkdir(parents=True)
    results.validation("curves.csv").write_text(CURVES)
    (root / "measurements").mkdir()
    for name, experiment in study.experiments.items():
        for quantity in experiment.signals:
            results.measurement(name, quantity).write_text("time_s,value\n0,0.777\n")
    results.measurements_summary.write_text("{}\n")
    origin = {
        "config_digest": digest(study.model_dump(mode="json")),
        "source_fingerprint": source_fingerprint(*STUDY),
        "code": code(study),
        "macfp_commit": COMMIT,
        "data": {"capa_25/mlr": {"source": "macfp:a.csv", "sha256": "abc"}},
    }
    (root / "provenance.json").write_text(json.dumps(origin))
    return results


@pytest.fixture
def pmma(tmp_path: Path) -> tuple[Study, Results]:
    study = read_study(PMMA)
    return study, results_of(study, tmp_path / "results")


def packed(archive: Path) -> dict[str, str]:
    with zipfile.ZipFile(archive) as file:
        return {name: file.read(name).decode() for name in file.namelist()}


def test_files_of_the_data_base_are_named_by_commit_and_checksum_and_not_copied(
    pmma: tuple[Study, Results],
) -> None:
    study, results = pmma
    held = packed(write_archive(study, results, [PMMA], ROOT))
    assert [n for n in held if n.startswith("data/")] == []
    measured = [n for n in held if n.startswith("results/measurements/")]
    assert measured == ["results/measurements/summary.json"]
    assert not [n for n in held if n.startswith(("results/", "data/")) and "777" in held[n]]
    assert COMMIT in held["README.txt"]
    assert (
        f"{len(set(study.needs_macfp))} measured files are part of the MaCFP" in held["README.txt"]
    )
    assert '"sha256": "abc"' in held["results/provenance.json"]


def test_given_files_of_one_name_are_all_kept(pmma: tuple[Study, Results], tmp_path: Path) -> None:
    given = [tmp_path / folder / "study.yaml" for folder in ("a", "b")]
    for path in given:
        path.parent.mkdir()
        path.write_text(f"{path.parent.name}\n")
    held = packed(write_archive(*pmma, given, ROOT))
    assert {held[n] for n in held if n.startswith("as_given/")} == {"a\n", "b\n"}


def test_columns_that_repeat_measured_values_keep_everything_else(
    pmma: tuple[Study, Results],
) -> None:
    held = packed(write_archive(*pmma, [PMMA], ROOT))
    assert held["results/validation/curves.csv"] == CURVES.replace("0.777", "").replace(
        '"300.1",777.7', "300.1,"
    )


def test_synthetic_measurements_are_copied(tmp_path: Path) -> None:
    smoke = ROOT / "config" / "smoke.yaml"
    study = read_study(smoke)
    held = packed(write_archive(study, results_of(study, tmp_path), [smoke], ROOT))
    assert "0.777" in held["results/measurements/slab_25_mlr.csv"]
    assert held["results/validation/curves.csv"] == CURVES
    assert "MaCFP" not in held["README.txt"]


def test_study_in_the_archive_is_the_study_that_was_run(
    pmma: tuple[Study, Results], tmp_path: Path
) -> None:
    study, results = pmma
    again = tmp_path / "study.yaml"
    again.write_text(packed(write_archive(study, results, [PMMA], ROOT))["study.yaml"])
    assert read_study(again) == study


def test_two_files_of_one_name_have_two_places(tmp_path: Path) -> None:
    study = read_study(ROOT / "config" / "smoke.yaml")
    experiments = dict(study.experiments)
    for folder, name in (("a", "tga_5K"), ("b", "tga_20K")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "tga.csv").write_text(folder)
        signal = experiments[name].signals["mass_fraction"]
        own = signal.model_copy(update={"file": (tmp_path / folder / "tga.csv").as_posix()})
        experiments[name] = experiments[name].model_copy(update={"signals": {"mass_fraction": own}})
    study = study.model_copy(update={"experiments": experiments})
    held = packed(write_archive(study, results_of(study, tmp_path / "results"), [], ROOT))
    assert {name: text for name, text in held.items() if name.startswith("data/")} == {
        "data/tga.csv": "a",
        "data/1_tga.csv": "b",
    }
    assert "file: data/tga.csv" in held["study.yaml"]
    assert "file: data/1_tga.csv" in held["study.yaml"]


def test_measured_file_that_was_replaced_after_the_run_is_not_packed(tmp_path: Path) -> None:
    study = read_study(ROOT / "config" / "smoke.yaml")
    file = tmp_path / "tga.csv"
    file.write_text("as it was read")
    signal = study.experiments["tga_5K"].signals["mass_fraction"]
    own = signal.model_copy(update={"file": file.as_posix()})
    tga = study.experiments["tga_5K"].model_copy(update={"signals": {"mass_fraction": own}})
    study = study.model_copy(update={"experiments": {**study.experiments, "tga_5K": tga}})
    results = results_of(study, tmp_path / "results")
    origin = json.loads((results.root / "provenance.json").read_text())
    read = {"source": file.as_posix(), "sha256": hashlib.sha256(file.read_bytes()).hexdigest()}
    origin["data"] = {"tga_5K/mass_fraction": read}
    (results.root / "provenance.json").write_text(json.dumps(origin))
    write_archive(study, results, [], ROOT)
    file.write_text("replaced")
    with pytest.raises(DataError, match=r"tga.csv: changed since it was read; run"):
        write_archive(study, results, [], ROOT)


def test_plugins_are_packed_and_found_again(tmp_path: Path) -> None:
    effects = tmp_path / "given" / "own" / "effects"
    effects.mkdir(parents=True)
    text = (ROOT / "src" / "pyrofit" / "effects" / "k_T.py").read_text()
    (effects / "k_T_again.py").write_text(text)
    keys = read_mapping(ROOT / "config" / "smoke.yaml")
    keys |= {"plugins": ["own"], "effects": {"k_T_again": {"slope_1_K": 1e-4}}}
    study = as_study(keys, str(tmp_path / "given" / "study.yaml"))
    archive = write_archive(study, results_of(study, tmp_path / "results"), [], ROOT)
    with zipfile.ZipFile(archive) as file:
        file.extractall(tmp_path / "again")
    assert (tmp_path / "again" / "plugins/0_own/effects/k_T_again.py").read_text() == text
    again = read_study(tmp_path / "again" / "study.yaml")
    assert again.material == study.material
    assert again.plugins == ((tmp_path / "again" / "plugins" / "0_own").as_posix(),)
    use_plugins([])


def test_entries_are_sorted_and_carry_no_date(pmma: tuple[Study, Results]) -> None:
    archive = write_archive(*pmma, [PMMA], ROOT)
    first = archive.read_bytes()
    with zipfile.ZipFile(archive) as file:
        entries = file.infolist()
    assert [e.filename for e in entries] == sorted(e.filename for e in entries)
    assert {e.date_time for e in entries} == {(1980, 1, 1, 0, 0, 0)}
    assert write_archive(*pmma, [PMMA], ROOT).read_bytes() == first


def test_results_left_of_an_earlier_study_stay_out(pmma: tuple[Study, Results]) -> None:
    study, results = pmma
    for place in ("imp/RMSE/00.json", "imp/RMSE/99.json", "imp/OLD/00.json", "tables/old.csv"):
        (results.root / place).parent.mkdir(parents=True, exist_ok=True)
        (results.root / place).write_text("{}")
    held = packed(write_archive(study, results, [PMMA], ROOT))
    assert "results/imp/RMSE/00.json" in held
    assert not {f"results/{n}" for n in ("imp/RMSE/99.json", "imp/OLD/00.json")} & set(held)
    assert "results/tables/old.csv" not in held


def test_results_of_another_source_are_refused(pmma: tuple[Study, Results]) -> None:
    study, results = pmma
    path = results.root / "provenance.json"
    path.write_text(path.read_text().replace(source_fingerprint(*STUDY), "0" * 16))
    with pytest.raises(DataError, match="pyrofit or its packages have changed since"):
        write_archive(study, results, [PMMA], ROOT)


def test_results_of_another_effect_are_refused(tmp_path: Path) -> None:
    keys = read_mapping(ROOT / "config" / "smoke.yaml") | {"effects": {"k_T": {"slope_1_K": 1e-4}}}
    study = as_study(keys, "smoke.yaml")
    results = results_of(study, tmp_path)
    path = results.root / "provenance.json"
    path.write_text(path.read_text().replace(code(study)["effects"]["k_T"], "0" * 16))
    with pytest.raises(DataError, match="an effect, a quantity or a cost has changed since"):
        write_archive(study, results, [PMMA], ROOT)


def test_results_of_another_study_are_refused(pmma: tuple[Study, Results]) -> None:
    study, results = pmma
    with pytest.raises(DataError, match="the study has changed since these results were made"):
        write_archive(study.model_copy(update={"seed": 1}), results, [PMMA], ROOT)


def test_archive_of_an_installed_package_has_the_versions_of_its_environment(
    pmma: tuple[Study, Results], tmp_path: Path
) -> None:
    held = packed(write_archive(*pmma, [PMMA], tmp_path))
    here = importlib.metadata.version("numpy")
    assert f"numpy=={here}\n" in held["software/requirements.txt"]
    assert "pip install -r requirements.txt" in held["README.txt"]
    assert "software/Makefile" not in held
    assert {WORKFLOW, "software/src/pyrofit/__main__.py"} <= set(held)


def test_study_that_was_not_run_has_no_archive(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["archive", "--study", str(PMMA), "--results", str(tmp_path)]) == 2
    assert "provenance.json: this result is missing; run the workflow" in capsys.readouterr().err
