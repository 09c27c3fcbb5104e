"""The tutorial, as a stranger follows it, and the archive that it ends with."""

import hashlib
import json
import os
import re
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pytest
from pages import BLOCK, LOCK, SOURCE, copy_project, follow, run
from tiny import ROOT

TUTORIAL = ROOT / "docs" / "tutorial.md"


@dataclass(frozen=True)
class Followed:
    """What the tutorial left behind."""

    root: Path
    said: str

    @property
    def results(self) -> Path:
        return self.root / "results" / "mypolymer_quick"


@pytest.fixture(scope="module")
def followed(tmp_path_factory: pytest.TempPathFactory) -> Followed:
    """Return a copy of the project in which all framed blocks were run, one after the other."""
    root = tmp_path_factory.mktemp("tutorial")
    copy_project(root)
    ran = follow(root, TUTORIAL)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    return Followed(root, ran.stdout)


@pytest.fixture(scope="module")
def unpacked(followed: Followed, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with what the tutorial's archive holds."""
    folder = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(followed.results / "mypolymer_quick.zip") as archive:
        archive.extractall(folder)
    return folder


def test_tutorial_recognises_its_files_and_its_study_is_valid(followed: Followed) -> None:
    assert "tga_20K.csv: mass_fraction: time 'time_s' in s, temperature" in followed.said
    assert "slab_25kW.csv: mlr: time 'time_s' in s, value" in followed.said
    assert followed.said.count("study 'mypolymer' is valid; 3 measured series read") == 2


def test_slab_that_is_held_out_is_predicted_and_the_report_says_so(followed: Followed) -> None:
    assert "Held out: slab_60kW." in followed.said
    page = (followed.results / "report.html").read_text(encoding="utf-8").replace("\xa0", " ")
    assert "held out: 60 kW/m²." in page
    table = (followed.results / "tables" / "validation.md").read_text(encoding="utf-8")
    fitted, predicted = table.split("## 60 kW/m²")
    assert "| held out |" in predicted
    assert "| fitted |" not in predicted
    assert "| held out |" not in fitted
    study = (followed.root / "mypolymer" / "mypolymer.yaml").read_text(encoding="utf-8")
    assert "{experiment: slab_25kW, signal: mlr" in study
    assert "{experiment: slab_60kW, signal: mlr" not in study


def test_tutorial_ends_in_a_report_and_a_table_of_what_the_data_determine(
    followed: Followed,
) -> None:
    page = (followed.results / "report.html").read_text(encoding="utf-8")
    assert "mypolymer" in page
    table = (followed.results / "tables" / "determined.md").read_text(encoding="utf-8")
    assert table in followed.said
    for name in ("T_p", "E_p", "rho", "k", "cp", "eps", "dh"):
        assert re.search(rf"^\| *{name} ", table, re.M) or f"| {name} |" in table, name


def test_changes_of_the_tutorial_reach_the_study(followed: Followed) -> None:
    # A pattern that no longer matches the written study would change nothing, silently.
    (block,) = [b for b in BLOCK.findall(TUTORIAL.read_text("utf-8")) if "sed" in b]
    patterns = re.findall(r"'s/(.*?)/(.*)/'", block)
    before = (followed.root / "mypolymer" / "mypolymer.yaml.bak").read_text(encoding="utf-8")
    after = (followed.root / "mypolymer" / "mypolymer.yaml").read_text(encoding="utf-8")
    assert len(patterns) > 5
    for old, new in patterns:
        assert old in before
        assert new in after


def test_archive_holds_what_its_checksums_say(unpacked: Path) -> None:
    sums = (unpacked / "SHA256SUMS").read_text().splitlines()
    listed = dict(reversed(line.split("  ")) for line in sums)
    there = {p.relative_to(unpacked).as_posix() for p in unpacked.rglob("*") if p.is_file()}
    assert there == {*listed, "SHA256SUMS"}
    for name, digest in listed.items():
        assert hashlib.sha256((unpacked / name).read_bytes()).hexdigest() == digest, name


def test_metadata_of_the_archive_name_nothing_that_it_lacks(unpacked: Path) -> None:
    crate = json.loads((unpacked / "ro-crate-metadata.json").read_text(encoding="utf-8"))
    local = {e["@id"] for e in crate["@graph"] if not e["@id"].startswith(("#", "http"))}
    assert {"study.yaml", "software/src/pyrofit/workflow/Snakefile", "results/report.html"} <= local
    assert [name for name in local if not (unpacked / name).exists()] == []


def test_archive_holds_study_files_results_and_software(followed: Followed, unpacked: Path) -> None:
    for name in ("mypolymer/mypolymer.yaml", "quick.yaml"):
        given = (followed.root / name).read_bytes()
        assert (unpacked / "as_given" / Path(name).name).read_bytes() == given
    for name in ("tga_20K.csv", "slab_25kW.csv", "slab_60kW.csv"):
        assert (unpacked / "data" / name).read_bytes() == (followed.root / name).read_bytes()
    left_out = {"inputs", "logs", "benchmarks", "mypolymer_quick.zip"}
    for path in followed.results.rglob("*"):
        place = path.relative_to(followed.results)
        if path.is_file() and place.parts[0] not in left_out:
            assert (unpacked / "results" / place).read_bytes() == path.read_bytes(), place
    for path in [*(SOURCE / "pyrofit").rglob("*"), *(ROOT / "workflow").rglob("*"), ROOT / LOCK]:
        if path.is_file() and "__pycache__" not in path.parts:
            place = path.relative_to(ROOT)
            assert (unpacked / "software" / place).read_bytes() == path.read_bytes(), place


def test_unpacked_study_passes_check_with_the_software_of_the_archive(unpacked: Path) -> None:
    software = unpacked / "software"
    ran = run(software, "pyrofit", "check", "../study.yaml", source=software / "src")
    assert ran.returncode == 0, ran.stderr
    assert "study 'mypolymer_quick' is valid; 3 measured series read; 1 repetitions" in ran.stdout


def test_unpacked_study_gives_the_same_results_again(unpacked: Path) -> None:
    study = ("--configfile", "../study.yaml")
    ran = run(unpacked / "software", "snakemake", "--cores", "2", *study)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    again = unpacked / "software" / "results" / "mypolymer_quick"
    # These name the files that were read, which lie elsewhere now; the report tells wall times.
    places = {"study.json", "report.html", "provenance.json", "measurements/summary.json"}
    compared = 0
    for path in (unpacked / "results").rglob("*"):
        place = path.relative_to(unpacked / "results").as_posix()
        if path.is_file() and place not in places:
            assert _without_digest(again / place) == _without_digest(path), place
            compared += 1
    assert compared > 50


def _without_digest(path: Path) -> bytes:
    """Return a result without the digest of the study, which knows where the files lay."""
    content = path.read_bytes()
    if path.suffix != ".json":
        return content
    return re.sub(rb'"(config_)?digest": "\w+"', b"", content)


def test_archive_of_the_same_results_has_the_same_bytes(followed: Followed) -> None:
    archive = followed.results / "mypolymer_quick.zip"
    before = archive.read_bytes()
    for path in followed.results.rglob("*.csv"):
        os.utime(path, (2e9, 2e9))
    command = ["pyrofit", "archive", "--study", str(followed.results / "study.json")]
    given = ["--given", "mypolymer/mypolymer.yaml", "quick.yaml"]
    ran = run(followed.root, *command, *given)
    assert ran.returncode == 0, ran.stderr
    assert archive.read_bytes() == before


def test_results_of_another_study_are_not_archived(followed: Followed) -> None:
    command = ["pyrofit", "archive", "--study", "mypolymer/mypolymer.yaml"]
    command += ["--results", "results/mypolymer_quick"]
    ran = run(followed.root, *command)
    assert ran.returncode == 2
    assert "the study has changed since these results were made; run the workflow" in ran.stderr
