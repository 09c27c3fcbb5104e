"""One run of a study at a time, of the study that it was started with."""

import os
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from tiny import FIT, OWN_FILE, Project

from pyrofit.errors import RUN
from pyrofit.running.lock import end_run, start_run
from pyrofit.running.plan import STUDY_OF_RUN

FOLDER = "results/tiny/running"
STUDY = "results/tiny/study.json"
INPUTS = "results/tiny/inputs/kinetics.json"
SERIES = "results/tiny/measurements/tga_own_mass_fraction.csv"
SUMMARY = "results/tiny/measurements/summary.json"
AS_A_JOB = ("--mode", "remote", "--target-jobs", "kinetics:", "--allowed-rules", "kinetics")
"""How a cluster's job calls Snakemake."""
JOB = (*AS_A_JOB, "--cores", "1", "--force", "--no-hooks", "--ignore-incomplete")


def wait_for(project: Project, name: str, process: "subprocess.Popen[str]") -> None:
    give_up = time.monotonic() + 300.0
    while not (project.root / name).exists():
        assert time.monotonic() < give_up
        assert process.poll() is None
        time.sleep(0.02)


def test_second_run_is_refused_and_edits_in_mid_run_change_nothing(
    untouched: Project, tmp_path: Path
) -> None:
    project = Project.copy(untouched.root, tmp_path / "project")
    with project.start("--cores", "1", FIT) as process:
        wait_for(project, SERIES, process)
        os.killpg(process.pid, signal.SIGSTOP)  # that it may not end too early
        frozen = project.read(STUDY)
        project.change("seed", 4)
        (project.root / "mine" / "data" / "run.csv").write_text(OWN_FILE.replace("5.0", "4.0"))
        second = project.snakemake("--cores", "1", FIT)
        for harmless in (("--dry-run",), ("--list-rules",)):
            assert project.snakemake(*harmless).code == 0
        assert project.read(STUDY) == frozen
        os.killpg(process.pid, signal.SIGCONT)
        said, _ = process.communicate()
    assert second.code != 0
    assert f"    kill {process.pid}    #" in second.said
    assert "another run of this study is alive" in second.said
    assert "Traceback" not in second.said
    assert process.returncode == 0, said
    for name in (STUDY, SERIES, SUMMARY, FIT):
        assert project.read(name) == untouched.read(name), name
    assert not (project.root / FOLDER).exists()
    # What was edited is seen by the next run.
    jobs = project.plan(FIT)
    assert {"Measured series into tidy tables, mass closure checked"} < jobs


def test_without_nolock_a_killed_run_is_unlocked_and_goes_on(
    untouched: Project, tmp_path: Path
) -> None:
    project = Project.copy(untouched.root, tmp_path / "project")
    bare = ("--workflow-profile", "none", "--cores", "1")
    with project.start(*bare, SERIES) as process:
        wait_for(project, f"{FOLDER}/run.json", process)
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
    locked = project.snakemake(*bare, SERIES)
    assert locked.code != 0
    assert "LockException" in locked.said
    assert project.snakemake(*bare, "--unlock").code == 0
    again = project.snakemake(*bare, "--rerun-incomplete", SERIES)
    assert again.code == 0, again.said
    assert "was broken off; going on" in again.said
    assert project.read(SERIES) == untouched.read(SERIES)


@pytest.fixture
def as_job(
    untouched: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Project]:
    """Return a finished project, as the job of a cluster finds it whose run is this process."""
    shutil.copytree(untouched.root, tmp_path / "project")
    project = Project(tmp_path / "project")
    root = project.root / "results" / "tiny"
    for name in (RUN, STUDY_OF_RUN):
        monkeypatch.setenv(name, "")  # so that it is restored at the end
    start_run(root)
    monkeypatch.delenv(STUDY_OF_RUN)
    yield project
    end_run(root)


@pytest.mark.parametrize("told", [STUDY, None], ids=["told", "not_told"])
def test_job_of_a_cluster_computes_the_study_that_its_run_was_started_with(
    told: str | None, as_job: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = {name: as_job.read(name) for name in (FIT, STUDY, INPUTS)}
    if told is not None:
        monkeypatch.setenv(STUDY_OF_RUN, told)
    as_job.change("seed", 4)
    run = as_job.snakemake(*JOB)
    assert run.code == 0, run.said
    assert "Kinetics fitted" in run.said
    for name, content in before.items():
        assert as_job.read(name) == content


def test_job_of_a_run_that_is_over_removes_no_result(
    as_job: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    fit = as_job.read(FIT)
    monkeypatch.setenv(RUN, "that of the run before")
    run = as_job.snakemake(*JOB)
    assert run.code != 0
    assert "the run that this job belongs to is over; nothing was written" in run.said
    assert as_job.read(FIT) == fit
