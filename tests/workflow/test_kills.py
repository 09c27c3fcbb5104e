"""A run may be killed at any moment: the same command goes on to the same bits."""

import contextlib
import os
import random
import re
import shutil
import signal
import subprocess
import time
from collections import Counter
from pathlib import Path

import pytest
from kill_bits import RESULTS, bits
from tiny import FIT, Project, kill

STAGES = (
    ("measurements",),
    ("kinetics",),
    ("imp",),
    ("identification", "comparison", "validation"),
    ("tables", "figures", "report.html", "provenance.json"),
)
"""Results of each stage."""
LONGEST_S = 12.0
"""Longest time between the start of the first job and the kill."""


def lock_of(project: Project) -> bytes:
    """Return the lock of a run, of a dead one too; nothing if there is none."""
    try:
        return project.read(str(RESULTS / "running/run.json"))
    except FileNotFoundError:
        return b""


def run_and_kill(project: Project, draw: random.Random) -> tuple[str, bool]:
    """Start or continue the whole study, and kill it; return what it said, and if it was faster."""
    before = lock_of(project)
    with project.start("--cores", str(draw.choice([1, 2]))) as process:
        while process.poll() is None and lock_of(project) in (before, b""):
            time.sleep(0.01)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(draw.uniform(0.0, LONGEST_S))
        ended = process.poll() is not None
        kill(process)
        said, _ = process.communicate()
    if ended:
        assert process.returncode == 0, said
    return said, ended


def begin(project: Project, finished: Project, stage: int) -> None:
    """Make the project one that has finished all before a stage."""
    shutil.rmtree(project.root, ignore_errors=True)
    shutil.copytree(finished.root, project.root)
    for names in STAGES[stage:]:
        for name in names:
            path = project.root / RESULTS / name
            shutil.rmtree(path) if path.is_dir() else path.unlink()


def cut_off(said: str) -> set[str]:
    """Return the jobs that were under way when a run was killed, by the first word of each."""
    begun = dict(re.findall(r"^(?:Job|local job) (\d+): (\w+)", said, re.M))
    done = set(re.findall(r"Finished jobid: (\d+)", said))
    return {word for jobid, word in begun.items() if jobid not in done}


def test_killed_runs_go_on_to_the_same_bits(
    untouched: Project, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """One kill that begins with each stage, with --thorough ten; at last a whole study."""
    each = 10 if request.config.getoption("--thorough") else 1
    right = bits(untouched)
    draw = random.Random(each)
    project = Project(tmp_path / "project")
    under_way: Counter[str] = Counter()
    for stage in reversed(range(len(STAGES))):
        begin(project, untouched, stage)
        done = 0
        while done < each:
            said, ended = run_and_kill(project, draw)
            assert "Traceback" not in said
            assert bits(project).items() <= right.items()
            if ended:
                assert bits(project) == right
                begin(project, untouched, stage)
            else:
                done += 1
                under_way.update(cut_off(said))
        print(f"stage {stage}: {done} kills; cut off so far: {dict(under_way)}", flush=True)
    last = project.snakemake("--cores", "2")
    assert last.code == 0, last.said
    assert bits(project) == right


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_run_ends_in_order_and_goes_on(
    untouched: Project, tmp_path: Path, number: signal.Signals
) -> None:
    project = Project.copy(untouched.root, tmp_path / "project")
    running = project.root / RESULTS / "running"
    with project.start("--cores", "1", FIT) as process:
        while process.poll() is None and not list(running.glob("job_*")):
            time.sleep(0.01)
        process.send_signal(number)
        said, _ = process.communicate(timeout=300)
    assert process.returncode == 128 + number
    assert "Traceback" not in said
    assert said.splitlines()[-1] == "interrupted; run again to go on, finished parts are kept"
    assert said.count("interrupted;") == 1
    assert not running.exists()
    again = project.snakemake("--cores", "1", FIT)
    assert again.code == 0, again.said
    assert project.read(FIT) == untouched.read(FIT)


def test_results_with_times_in_the_future_stay_right(untouched: Project, tmp_path: Path) -> None:
    # As after a clock that was set back while the study ran.
    shutil.copytree(untouched.root, tmp_path / "project")
    project = Project(tmp_path / "project")
    right = bits(project)
    future = time.time() + 86400.0
    for name in ("tga_20K_mass_fraction", "slab_60_mlr"):
        os.utime(project.root / RESULTS / "measurements" / f"{name}.csv", (future, future))
    run = project.snakemake("--cores", "2", FIT)
    assert run.code == 0, run.said
    assert bits(project) == right
