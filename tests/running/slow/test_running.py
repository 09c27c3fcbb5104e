"""One run of a study at a time: who is alive, who is refused, whose lock is taken over."""

import dataclasses
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from pyrofit.errors import RUN
from pyrofit.running import lock, processes
from pyrofit.running.lock import FOLDER, RunError, end_run, job, join_run, start_run
from pyrofit.running.processes import this_process

HOLD = """
import sys, time
from pathlib import Path
from pyrofit.running import lock
try:
    {holds}
    print("holds", flush=True)
    time.sleep(600)
except lock.RunError as error:
    print(error, flush=True)
"""
START = "lock.start_run(Path(sys.argv[1]))"
JOB = "held = lock.job(Path(sys.argv[1])); held.__enter__()"


@pytest.fixture(autouse=True)
def _no_run_above(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(RUN, "")  # so that it is restored at the end
    monkeypatch.delenv(RUN)


class Other:
    """Another process that starts a run, or does a job, and says how that went."""

    def __init__(self, root: Path, holds: str = START, **environment: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-c", HOLD.format(holds=holds), str(root)],
            env={**os.environ, **environment},
            stdout=subprocess.PIPE,
            text=True,
        )

    @property
    def said(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline()

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()


@pytest.fixture
def root(tmp_path: Path) -> Iterator[Path]:
    yield tmp_path / "results" / "tiny"
    end_run(tmp_path / "results" / "tiny")


@pytest.fixture
def run(root: Path) -> Iterator[Other]:
    """Return a run in another process."""
    other = Other(root)
    assert other.said == "holds\n"
    yield other
    other.kill()


def rewrite(root: Path, **values: object) -> None:
    """Change the description of the process in the lock."""
    path = root / FOLDER / "run.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | values))


def start_and_end(root: Path) -> str:
    told = start_run(root)
    end_run(root)
    return told


# --- runs -----------------------------------------------------------------------------------


def test_second_run_is_refused_with_the_line_that_ends_the_first(root: Path, run: Other) -> None:
    with pytest.raises(RunError) as error:
        start_run(root)
    line = f"kill {run.process.pid}"
    assert f"\n    {line}    #" in str(error.value)
    subprocess.run(["bash", "-c", line], check=True)
    run.process.wait()
    assert "broken off" in start_run(root)


def test_lock_of_a_killed_run_is_taken_over(root: Path, run: Other) -> None:
    run.kill()
    assert "was broken off; going on" in start_run(root)
    assert json.loads((root / FOLDER / "run.json").read_text())["pid"] == os.getpid()


def test_end_of_a_run_leaves_nothing(root: Path) -> None:
    assert start_and_end(root) == ""
    assert list(root.iterdir()) == []
    assert start_and_end(root) == ""


def test_number_of_a_process_that_is_used_again_is_not_taken_for_it(root: Path, run: Other) -> None:
    run.kill()
    rewrite(root, pid=os.getpid())
    assert "broken off" in start_and_end(root)


@pytest.mark.parametrize("content", ["", "{", "[1]", '{"token": "x"}'])
def test_damaged_lock_is_that_of_a_dead_run(content: str, root: Path) -> None:
    (root / FOLDER).mkdir(parents=True)
    (root / FOLDER / "run.json").write_text(content)
    start_and_end(root)
    assert list(root.iterdir()) == []


@pytest.mark.parametrize("content", ["", None])
def test_lock_that_another_run_takes_meanwhile_stays_its_own(
    content: str | None, root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = root / FOLDER / "run.json"
    if content is not None:
        path.parent.mkdir(parents=True)
        path.write_text(content)
    read, others = lock._read, []

    def read_then_another_starts(asked: Path) -> lock.Mark | None:
        found = read(asked)
        if asked == path and not others:
            path.unlink(missing_ok=True)
            others.append(Other(root))
            assert others[0].said == "holds\n"
        return found

    monkeypatch.setattr(lock, "_read", read_then_another_starts)
    with pytest.raises(RunError):
        start_run(root)
    kept = json.loads(path.read_text())
    others[0].kill()
    assert kept["pid"] == others[0].process.pid


def test_process_that_the_system_hides_counts_as_alive(
    root: Path, run: Other, monkeypatch: pytest.MonkeyPatch
) -> None:
    # As /proc mounted with hidepid shows a run of another user.
    show = Path.read_text

    def hide(path: Path, *given: Any, **named: Any) -> str:
        if path == Path(f"/proc/{run.process.pid}/stat"):
            raise FileNotFoundError
        return show(path, *given, **named)

    monkeypatch.setattr(Path, "read_text", hide)
    with pytest.raises(RunError, match="is alive"):
        start_run(root)
    run.kill()
    assert "broken off" in start_run(root)


def test_of_many_runs_that_start_together_one_goes_on(root: Path, run: Other) -> None:
    run.kill()  # with a lock to be taken over
    others = [Other(root) for _ in range(6)]
    said = [other.said for other in others]
    assert said.count("holds\n") == 1, said
    for other in others:
        other.kill()


def test_run_deletes_what_killed_processes_left_half_written(root: Path) -> None:
    left = root / "imp" / ".summary.csv.0123.part"
    left.parent.mkdir(parents=True)
    left.touch()
    kept = root / "imp" / ".hidden"
    kept.touch()
    start_run(root)
    assert not left.exists()
    assert kept.exists()


# --- other machines -------------------------------------------------------------------------


@pytest.fixture
def elsewhere(root: Path, run: Other, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the lock of a run on another machine, which does not touch it."""
    run.kill()
    monkeypatch.setattr(processes, "BEAT_S", 0.05)
    monkeypatch.setattr(processes, "SILENCE_S", 0.5)
    monkeypatch.setenv("PATH", "/nowhere")
    rewrite(root, host="node7", machine="another")
    return root / FOLDER / "run.json"


@pytest.mark.parametrize("step_s", [1.0, -1.0], ids=["clock goes on", "clock goes backwards"])
def test_run_on_another_machine_lives_as_long_as_it_touches_its_lock(
    step_s: float, elsewhere: Path, root: Path
) -> None:
    over = threading.Event()

    def beat() -> None:
        at = 1e9
        while not over.wait(0.05):
            at += step_s
            os.utime(elsewhere, (at, at))

    beating = threading.Thread(target=beat)
    beating.start()
    try:
        with pytest.raises(RunError, match=r"ssh node7 kill \d+"):
            start_run(root)
    finally:
        over.set()
        beating.join()
    assert "broken off" in start_run(root)


def test_lock_with_a_time_in_the_future_is_not_taken_for_alive(elsewhere: Path, root: Path) -> None:
    future = time.time() + 1e6
    os.utime(elsewhere, (future, future))
    assert "broken off" in start_run(root)


def squeue(folder: Path, script: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Put a program of this name before all others."""
    folder.mkdir()
    (folder / "squeue").write_text(f"#!/bin/sh\n{script}\n")
    (folder / "squeue").chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:/usr/bin:/bin")


@pytest.mark.parametrize(
    ("script", "alive"),
    [
        ("echo RUNNING", True),
        ("echo PENDING", True),
        ("echo COMPLETING", True),
        ("echo COMPLETED", False),
        ("exit 0", False),
        ("echo 'slurm_load_jobs error: Invalid job id specified' >&2; exit 1", False),
    ],
)
@pytest.mark.usefixtures("elsewhere")
def test_slurm_tells_whether_a_job_lives(
    script: str, alive: bool, root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    squeue(tmp_path / "bin", script, monkeypatch)
    rewrite(root, slurm_job="77")
    if alive:
        with pytest.raises(RunError, match="scancel 77"):
            start_run(root)
    else:
        assert "Slurm job 77 was broken off" in start_run(root)


# --- jobs -----------------------------------------------------------------------------------


def test_run_does_not_start_beside_a_job_of_a_killed_one(root: Path, run: Other) -> None:
    token = json.loads((root / FOLDER / "run.json").read_text())["token"]
    left = Other(root, JOB, **{RUN: token})
    assert left.said == "holds\n"
    run.kill()
    with pytest.raises(RunError, match=f"kill {left.process.pid} ") as error:
        start_run(root)
    assert str(run.process.pid) not in str(error.value)
    left.kill()
    start_run(root)
    assert not list((root / FOLDER).glob("job_*"))


def test_job_of_a_run_that_was_replaced_is_refused(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    start_run(root)
    with job(root):
        assert len(list((root / FOLDER).glob("job_*"))) == 1
    monkeypatch.setenv(RUN, "that of the run before")
    with pytest.raises(RunError, match="the run that this job belongs to is over"), job(root):
        pass
    assert not list((root / FOLDER).glob("job_*"))


def test_job_of_a_run_that_has_ended_is_refused(root: Path) -> None:
    start_and_end(root)
    assert RUN in os.environ
    with pytest.raises(RunError, match="is over; nothing was written"), job(root):
        pass


def test_step_by_hand_is_refused_beside_a_run_and_stops_one_from_starting(
    root: Path, run: Other
) -> None:
    with pytest.raises(RunError, match=f"kill {run.process.pid}"), job(root):
        pass
    run.kill()
    step = Other(root, JOB)
    assert step.said == "holds\n"
    with pytest.raises(RunError, match=f"kill {step.process.pid}"):
        start_run(root)
    step.kill()


def test_steps_by_hand_may_go_on_side_by_side(root: Path) -> None:
    with job(root), job(root):
        pass


def test_job_whose_cluster_hands_on_no_variables_finds_its_run(root: Path) -> None:
    start_run(root)
    del os.environ[RUN]
    join_run(root)
    with job(root):
        pass


def test_process_is_told_with_user_machine_and_job(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SLURM_JOB_ID", "12")
    process = dataclasses.replace(this_process(), host="login1", user="ada", pid=3)
    assert str(process) == "process 3 of ada on login1, Slurm job 12"
    assert processes.line_that_ends(process) == "scancel 12"


def test_zombie_is_dead(root: Path, run: Other) -> None:
    os.kill(run.process.pid, signal.SIGKILL)
    for _ in range(200):
        if lock._read(root / FOLDER / "run.json") and not processes._started(run.process.pid):
            break
        time.sleep(0.02)
    assert "broken off" in start_run(root)
