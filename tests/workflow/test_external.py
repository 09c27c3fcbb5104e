"""A campaign with an external program: it survives failures, kills and other numbers of cores."""

import os
import shutil
import time
from pathlib import Path

import pytest
from decay import study, write
from tiny import ROOT, Project, Run, kill

SUMMARY, SCORES = "results/decay/imp/summary.csv", "results/decay/validation/scores.csv"
HISTORIES = [f"results/decay/imp/RMSE/{n:02d}{end}" for n in (0, 1) for end in (".csv.gz", ".json")]
MODE = "fails above 0.04"
SEARCHES = {f"Inverse modelling, RMSE, repetition {n:02d}" for n in (0, 1)}
TRIAL = "External programs: one timed run, and what the campaign costs"


def made(root: Path, monkeypatch: pytest.MonkeyPatch) -> Project:
    """Return a project, in a folder with a space, whose study an external program simulates."""
    project = Project.copy(ROOT, root / "my project")
    write(project.root / "mine", MODE)
    project.write(study())
    monkeypatch.setenv("RUNS", str(project.root / "runs.txt"))
    monkeypatch.setenv("PYROFIT_SCRATCH", str(project.root / "scratch"))
    return project


def runs(project: Project) -> list[str]:
    path = project.root / "runs.txt"
    return path.read_text().splitlines() if path.exists() else []


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Project, Run]:
    """Return a campaign that was not interrupted, on two cores."""
    with pytest.MonkeyPatch.context() as patch:
        project = made(tmp_path_factory.mktemp("whole"), patch)
        run = project.snakemake("--cores", "2", SUMMARY, SCORES)
    assert run.code == 0, run.said
    return project, run


def test_costs_are_said_first_and_failures_are_kept(whole: tuple[Project, Run]) -> None:
    project, run = whole
    assert {TRIAL} | SEARCHES <= run.jobs
    said = run.said
    assert said.index("plate: one run of python") < said.index("Inverse modelling, RMSE")
    assert "model calls (" in said
    failed = list(project.root.glob("results/decay/programs/plate/failed/*.json"))
    assert failed
    assert '"exit_status": 3' in failed[0].read_text()
    assert len(runs(project)) == len(set(runs(project)))
    assert not project.plan(SUMMARY, SCORES)
    assert list((project.root / "scratch").iterdir()) == []


def test_a_killed_campaign_goes_on_without_running_a_set_again(
    whole: tuple[Project, Run], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    project = made(tmp_path, monkeypatch)
    monkeypatch.setenv("SLOW", "0.05")
    with project.start("--cores", "1", SUMMARY) as process:
        give_up = time.monotonic() + 120.0
        while len(runs(project)) < 12:
            assert time.monotonic() < give_up
            assert process.poll() is None
            time.sleep(0.02)
        kill(process)
        process.communicate()
    before = len(runs(project))
    assert not (project.root / HISTORIES[1]).exists()
    monkeypatch.setenv("SLOW", "0")
    resumed = project.snakemake("--cores", "1", SUMMARY, SCORES)
    assert resumed.code == 0, resumed.said
    for name in (SUMMARY, SCORES, *HISTORIES):
        assert project.read(name) == whole[0].read(name), name
    # The run that was killed is the only one that was made twice.
    after = runs(project)
    assert len(after) - len(set(after)) <= 1
    assert set(after) == set(runs(whole[0]))
    assert before < len(after)
    assert list((project.root / "scratch").iterdir()) == []


def test_an_edited_template_or_file_runs_again_what_it_changes(whole: tuple[Project, Run]) -> None:
    project, _ = whole
    for name in ("decay.inp", "decay.py"):
        path = project.root / "mine" / name
        before, times = path.read_text(), path.stat()
        path.write_text(before + "\n# edited = 1\n")
        try:
            planned = project.plan(SUMMARY, SCORES)
        finally:
            path.write_text(before)
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
        assert {TRIAL} | SEARCHES <= planned
    assert not project.plan(SUMMARY, SCORES)


@pytest.mark.parametrize("name", ["hotplate", "paper_fds", "pmma_gpyro"])
def test_shipped_campaigns_are_planned_without_their_programs(
    name: str, whole: tuple[Project, Run]
) -> None:
    project, _ = whole
    mine = project.root / "mine"
    before = (mine / "tiny.yaml").read_text()
    shutil.copytree(project.root / "config" / "templates", mine / "templates", dirs_exist_ok=True)
    shutil.copy(project.root / "config" / f"{name}.yaml", mine / "tiny.yaml")
    try:
        planned = project.plan()
    finally:
        (mine / "tiny.yaml").write_text(before)
    assert TRIAL in planned
    assert "What the data determine of the inverse modelling" in planned


def test_the_diagnosis_is_refused_in_words(whole: tuple[Project, Run]) -> None:
    run = whole[0].snakemake("--cores", "1", "diagnose")
    assert run.code != 0
    assert "an external program has a model of its own" in run.said
    assert "Traceback" not in run.said
