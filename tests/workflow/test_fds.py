"""The targets of FDS: both versions of the files, and a check that says where there is no FDS."""

import json

import pytest
from tiny import Project


@pytest.fixture(autouse=True)
def _no_fds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PYROFIT_FDS", raising=False)


def test_the_target_writes_both_versions_of_the_fitted_material(project: Project) -> None:
    run = project.snakemake("--cores", "1", "fds")
    assert run.code == 0, run.said
    folder = project.root / "results" / "tiny" / "fds"
    old, new = ((folder / version / "material.fds").read_text() for version in ("6.7", "6.8"))
    assert "ADJUST_H" not in old
    assert "ADJUST_H=.FALSE." in new
    for text in (old, new):
        assert "set 'estimates'" in text
        assert "which does not hold this value" not in text
        assert "fitted to slab_60 mlr" in text
        assert "95 % interval" in text


def test_the_check_without_fds_says_so_and_succeeds(project: Project) -> None:
    run = project.snakemake("--cores", "1", "fds_check")
    assert run.code == 0, run.said
    folder = project.root / "results" / "tiny" / "fds"
    assert json.loads((folder / "check.json").read_text()) == []
    assert "no FDS found; set PYROFIT_FDS" in (folder / "check.md").read_text()
