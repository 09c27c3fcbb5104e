"""The diagnosis as a target of the workflow: what it leaves, what is kept, what runs again."""

import json
import shutil
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from golden import moved
from tiny import OWN_FILE, ROOT, TINY, Project, Run, kill

PREPARE = "Measured series into tidy tables, mass closure checked"
DIAGNOSIS = "Which effect the model lacks"
PAGE = "Diagnosis: results/tiny/diagnosis/report.html"
FOLDER = "results/tiny/diagnosis"
FOUND = (f"{FOLDER}/diagnosis.json", f"{FOLDER}/curves.csv", f"{FOLDER}/extended.yaml")
LOG = "results/tiny/logs/diagnosis.log"
MEASURED = "results/tiny/measurements/slab_60_mlr.csv"
EFFECTS = ["c_T", "flux_decay", "heater_ramp", "k_T", "time_offset"]


def described() -> dict[str, Any]:
    """Return the tiny study, its heater in truth slow to come up, both slabs fitted."""
    study: dict[str, Any] = json.loads(json.dumps(TINY))
    study["synthetic"]["effects"] = {"heater_ramp": {"time_s": 15}}
    for name in ("slab_60", "slab_80"):
        study["experiments"][name]["signals"]["mlr"]["every"] = 5
        study["experiments"][name]["signals"]["mlr"]["average_s"] = 5
    study["diagnosis"] = {
        "calibrate": {"slab_60": ["mlr"], "slab_80": ["mlr"]},
        "estimate": ["T_p", "E_p", "rho", "k"],
        "effects": EFFECTS,
    }
    return study


def changed(place: str, value: object) -> dict[str, Any]:
    study = described()
    *above, last = place.split(".")
    part = study
    for key in above:
        part = part.setdefault(key, {})
    part[last] = value
    return study


def workflow_only(to: Path) -> Project:
    """Copy the workflow without the source: kernels would be compiled anew for the copy's path."""
    for folder in ("workflow", "profiles", "config"):
        shutil.copytree(ROOT / folder, to / folder)
    shutil.copy2(ROOT / "Snakefile", to)
    (to / "mine" / "data").mkdir(parents=True)
    (to / "mine" / "data" / "run.csv").write_text(OWN_FILE)
    return Project(to)


@dataclass(frozen=True)
class Diagnosed:
    """A project whose study was diagnosed on two cores, that run, and what it left."""

    project: Project
    run: Run
    left: dict[str, bytes]

    def again(self, cores: str, target: str = "diagnose") -> Run:
        run = self.project.snakemake("--cores", cores, target)
        assert run.code == 0, run.said
        return run

    def now(self) -> dict[str, bytes]:
        return {name: self.project.read(name) for name in FOUND}

    def forget(self) -> None:
        """Delete what the diagnosis left."""
        shutil.rmtree(self.project.root / FOLDER)
        (self.project.root / LOG).unlink()


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Diagnosed:
    project = workflow_only(tmp_path_factory.mktemp("diagnosed") / "project")
    project.write(described())
    run = project.snakemake("--cores", "2", "diagnose")
    assert run.code == 0, run.said
    return Diagnosed(project, run, {name: project.read(name) for name in FOUND})


@pytest.fixture
def diagnosed(first: Diagnosed, tmp_path: Path) -> Iterator[Diagnosed]:
    """Return the diagnosed project; put back what a test has changed."""
    kept = tmp_path / "kept"
    for name in (".snakemake", "results"):
        shutil.copytree(first.project.root / name, kept / name)
    yield first
    first.project.write(described())
    for name in (".snakemake", "results"):
        shutil.rmtree(first.project.root / name)
        shutil.copytree(kept / name, first.project.root / name)


def test_diagnosis_is_as_stored(first: Diagnosed) -> None:
    assert moved(first.project.root / "results" / "tiny", "tiny_diagnosis") == []


def test_diagnosis_needs_the_measurements_only(first: Diagnosed) -> None:
    assert first.run.jobs == {PREPARE, DIAGNOSIS, PAGE}


def test_run_leaves_results_page_figures_and_tables(diagnosed: Diagnosed) -> None:
    root = diagnosed.project.root
    folder = root / FOLDER
    found = json.loads((folder / "diagnosis.json").read_text())
    assert found["verdict"]["groups"] == ["timing"]
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert TINY["title"] in page
    assert "heater_ramp" in page
    names = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    figures = {name for name in names if name.endswith(".svg")}
    assert len(figures) >= 3
    assert {name.replace(".svg", ".png") for name in figures} <= names
    tables = {name for name in names if name.startswith("tables/") and name.endswith(".csv")}
    assert tables
    assert {name.replace(".csv", ".md") for name in tables} <= names
    assert {"curves.csv", "extended.yaml"} <= names
    assert [p.name for p in (root / "results").rglob(".*")] == []
    log = (root / LOG).read_text()
    assert found["verdict"]["words"] in log


def test_extended_study_runs_as_it_is(diagnosed: Diagnosed) -> None:
    root = diagnosed.project.root
    computed, shown = "validation/scores.csv", "tables/answer.md"
    files = [f"results/tiny_extended/{name}" for name in (computed, shown)]
    run = diagnosed.project.snakemake("--cores", "2", *files, "--configfile", FOUND[2])
    assert run.code == 0, run.said
    study = json.loads((root / "results" / "tiny_extended" / "study.json").read_text())
    assert list(study["with_effects"]) == ["heater_ramp"]


def test_second_call_has_nothing_to_do(diagnosed: Diagnosed) -> None:
    run = diagnosed.again("2")
    assert "Nothing to be done" in run.said
    assert run.jobs == set()


CHANGES: dict[str, tuple[str, object, set[str]]] = {
    "candidates": ("diagnosis.effects", ["k_T", "heater_ramp"], {DIAGNOSIS, PAGE}),
    "title": ("title", "Another title", {PAGE}),
    "repetitions of the inverse modelling": ("imp.repetitions", 7, {PAGE}),
    "seed": ("seed", 4, {PREPARE, DIAGNOSIS, PAGE}),
}


@pytest.mark.parametrize(("place", "value", "jobs"), CHANGES.values(), ids=CHANGES)
def test_change_runs_again_what_depends_on_it_and_no_more(
    place: str, value: object, jobs: set[str], diagnosed: Diagnosed
) -> None:
    diagnosed.project.write(changed(place, value))
    assert diagnosed.project.plan("diagnose") == jobs


def test_changed_candidates_are_tried_and_the_measurements_stay(diagnosed: Diagnosed) -> None:
    before = diagnosed.project.read(MEASURED)
    diagnosed.project.write(changed("diagnosis.effects", ["k_T", "heater_ramp"]))
    assert diagnosed.again("2").jobs == {DIAGNOSIS, PAGE}
    found = json.loads(diagnosed.project.read(FOUND[0]))
    assert {row["effect"] for row in found["screen"]} == {"k_T", "heater_ramp"}
    assert diagnosed.project.read(MEASURED) == before


def test_one_core_finds_the_same_bytes_as_two(diagnosed: Diagnosed) -> None:
    diagnosed.forget()
    assert diagnosed.again("1", FOUND[0]).jobs == {DIAGNOSIS}
    assert diagnosed.now() == diagnosed.left


def test_killed_diagnosis_goes_on_to_the_same_bytes(diagnosed: Diagnosed) -> None:
    diagnosed.forget()
    log = diagnosed.project.root / LOG
    with diagnosed.project.start("--cores", "2", FOUND[0]) as process:
        give_up = time.monotonic() + 120.0
        while process.poll() is None and not (log.exists() and "chi-square" in log.read_text()):
            assert time.monotonic() < give_up
            time.sleep(0.005)
        kill(process)
        process.communicate()
    assert process.returncode != 0
    assert not (diagnosed.project.root / FOUND[0]).exists()
    assert diagnosed.again("2", FOUND[0]).jobs == {DIAGNOSIS}
    assert diagnosed.now() == diagnosed.left
    assert [p.name for p in (diagnosed.project.root / "results").rglob(".*")] == []


def test_stability_has_a_job_for_each_draw_and_runs_only_new_ones(diagnosed: Diagnosed) -> None:
    job, gathered = (
        "Diagnosis of disturbed data, draw {}",
        "Stability of the diagnosis: tables and figure",
    )
    diagnosed.project.write(changed("steps.stability.draws", 2))
    assert diagnosed.again("2", "stability").jobs == {job.format(0), job.format(1), gathered}
    first = diagnosed.project.read("results/tiny/stability/draw_0.json")
    table = diagnosed.project.read("results/tiny/stability/table_effects.md").decode()
    assert "heater_ramp" in table
    assert diagnosed.now() == diagnosed.left
    assert diagnosed.again("2", "stability").jobs == set()
    diagnosed.project.write(changed("steps.stability.draws", 3))
    assert diagnosed.again("2", "stability").jobs == {job.format(2), gathered}
    assert diagnosed.project.read("results/tiny/stability/draw_0.json") == first


def test_wrong_candidate_is_told_and_the_results_stay(diagnosed: Diagnosed) -> None:
    diagnosed.project.write(changed("diagnosis.effects", ["k_T", "heater_rampp"]))
    run = diagnosed.project.snakemake("--cores", "2", "diagnose")
    assert run.code != 0
    assert "unknown effect 'heater_rampp'. Did you mean 'heater_ramp'?" in run.said
    assert "Traceback" not in run.said
    assert diagnosed.now() == diagnosed.left
