"""One finished run, shared by all tests of the workflow."""

import fcntl
import json
import os
import shutil
from dataclasses import asdict
from pathlib import Path

import pytest
from tiny import ROOT, TINY, Project, Run


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Run]:
    """Return a folder with the whole tiny study run on two cores, and what the run said.

    Processes that run tests side by side share it: the first one makes it, the others wait.
    """
    shared = tmp_path_factory.getbasetemp()
    shared = (shared.parent if "PYTEST_XDIST_WORKER" in os.environ else shared) / "finished"
    told = shared / "run.json"
    shared.mkdir(exist_ok=True)
    with (shared / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not told.exists():
            shutil.rmtree(shared / "project", ignore_errors=True)
            run = Project.copy(ROOT, shared / "project").snakemake("--cores", "2")
            told.write_text(json.dumps(asdict(run)))
    run = Run(**json.loads(told.read_text()))
    assert run.code == 0, run.said
    return shared / "project", run


@pytest.fixture(scope="session")
def finished(
    made: tuple[Path, Run], tmp_path_factory: pytest.TempPathFactory
) -> tuple[Project, Run]:
    """Return a copy of the finished project that tests change, and what the run said."""
    folder, run = made
    root = tmp_path_factory.mktemp("finished") / "project"
    shutil.copytree(folder, root)
    return Project(root), run


@pytest.fixture(scope="session")
def untouched(made: tuple[Path, Run]) -> Project:
    """Return the finished project that no test changes."""
    return Project(made[0])


@pytest.fixture
def project(finished: tuple[Project, Run]) -> Project:
    """Return the finished project with its study as it was run."""
    finished[0].write(TINY)
    return finished[0]
