"""One finished run, shared by all tests of the workflow."""

import shutil

import pytest
from tiny import ROOT, TINY, Project, Run


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> tuple[Project, Run]:
    """Return a project with the whole tiny study run on two cores."""
    project = Project.copy(ROOT, tmp_path_factory.mktemp("finished") / "project")
    run = project.snakemake("--cores", "2")
    assert run.code == 0, run.said
    shutil.copytree(project.root, project.root.with_name("untouched"))
    return project, run


@pytest.fixture(scope="session")
def untouched(finished: tuple[Project, Run]) -> Project:
    """Return a copy of the finished project that no test changes."""
    return Project(finished[0].root.with_name("untouched"))


@pytest.fixture
def project(finished: tuple[Project, Run]) -> Project:
    """Return the finished project with its study as it was run."""
    finished[0].write(TINY)
    return finished[0]
