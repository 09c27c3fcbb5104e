"""Full disks and folders that cannot be written: a clear error, and the next run completes."""

import os
import resource
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from kill_bits import RESULTS, bits
from tiny import FIT, Project

STUDY = ("--study", str(RESULTS / "study.json"))
STEPS = {
    "prepare": ("measurements",),
    "kinetics": ("kinetics/fit.json", "kinetics/history.csv.gz", "kinetics/convergence.csv"),
    "identify --stage kinetics": ("identification/kinetics", "kinetics/sets.json"),
    "imp --cost RMSE --repetition 0 1": ("imp/RMSE/00.json",),
    "collect": ("imp/summary.csv",),
    "predict": ("validation",),
    "identify": ("identification/imp",),
    "compare": ("comparison",),
    "show --subject fit": ("tables/table4.csv",),
    "show --subject validation": ("figures/fig3.svg",),
    "report": ("report.html",),
}
"""Commands, and results that are deleted before."""
ROOM = 400
"""Largest file that can be written [bytes]: those of running processes, and short results."""


@pytest.fixture(scope="module")
def whole(
    untouched: Project, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Project, dict[str, str]]:
    """Return a copy of the finished project, with the digests of its results."""
    to = tmp_path_factory.mktemp("disk") / "project"
    shutil.copytree(untouched.root, to)
    return Project(to), bits(Project(to))


def step(project: Project, command: str, room: int | None = None) -> tuple[int, str]:
    """Call a step by hand, on a disk with so much room for each file."""

    def limit() -> None:
        if room is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))

    ran = subprocess.run(
        ["pyrofit", *command.split(), *STUDY],
        cwd=project.root,
        env=project.environment,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=limit,
    )
    return ran.returncode, ran.stdout + ran.stderr


@pytest.mark.parametrize(("command", "removed"), STEPS.items(), ids=lambda given: str(given)[:12])
def test_step_on_a_full_disk_says_so_and_completes_when_there_is_room(
    command: str, removed: tuple[str, ...], whole: tuple[Project, dict[str, str]]
) -> None:
    project, right = whole
    for name in removed:
        path = project.root / RESULTS / name
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    code, said = step(project, command, ROOM)
    assert code == 2, said
    assert "cannot be written (File too large); make room" in said
    assert "Traceback" not in said
    assert not list((project.root / RESULTS).rglob(".*"))
    assert bits(project).items() <= right.items()
    code, said = step(project, command)
    assert code == 0, said
    assert bits(project) == right


@pytest.fixture
def small_disk(untouched: Project, tmp_path: Path) -> Iterator[Project]:
    """Return a project whose results lie on a file system of 64 kB."""
    project = Project.copy(untouched.root, tmp_path / "project")
    results = project.root / "results"
    results.mkdir()
    if not mounted("-t", "tmpfs", "-o", "size=64k", "tmpfs", str(results)):
        pytest.skip("no file system can be mounted here")
    yield project
    subprocess.run(["umount", "--lazy", str(results)], check=True)


def mounted(*arguments: str) -> bool:
    if shutil.which("mount") is None or os.getuid() != 0:
        return False
    return subprocess.run(["mount", *arguments], capture_output=True, check=False).returncode == 0


def test_run_on_a_small_disk_and_a_read_only_one_goes_on_when_there_is_room(
    small_disk: Project, untouched: Project
) -> None:
    results = str(small_disk.root / "results")
    filling = Path(results) / "filling"
    filling.write_bytes(b"x" * 48_000)
    full = small_disk.snakemake("--cores", "1", FIT)
    assert full.code != 0
    assert "cannot be written (No space left on device); make room" in full.said
    assert "Traceback" not in full.said
    filling.unlink()
    assert mounted("-o", "remount,ro,size=10m", results)
    closed = small_disk.snakemake("--cores", "1", FIT)
    assert closed.code != 0
    assert "cannot be written (Read-only file system)" in closed.said
    assert "Traceback" not in closed.said
    assert mounted("-o", "remount,rw,size=10m", results)
    again = small_disk.snakemake("--cores", "1", FIT)
    assert again.code == 0, again.said
    assert small_disk.read(FIT) == untouched.read(FIT)
