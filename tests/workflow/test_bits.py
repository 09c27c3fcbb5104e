"""The same bits on every processor: a whole run and a diagnosis against stored checksums.

After a change that moves results on purpose,

    PYROFIT_WRITE_GOLDEN=1 pytest tests/workflow -k as_stored

stores them again. They are those of `requirements.lock`.
"""

import shutil
from pathlib import Path

import pytest
from golden import AVX2, moved
from test_diagnose import described
from tiny import ROOT, Project


def test_run_is_as_stored(untouched: Project) -> None:
    assert moved(untouched.root / "results" / "tiny", "tiny") == []


def test_processor_without_avx512_leaves_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in AVX2.items():
        monkeypatch.setenv(name, value)
    project = Project.copy(ROOT, tmp_path / "project")
    results = project.root / "results" / "tiny"
    run = project.snakemake("--cores", "2")
    assert run.code == 0, run.said
    assert moved(results, "tiny") == []
    shutil.rmtree(results)
    project.write(described())
    run = project.snakemake("--cores", "2", "diagnose")
    assert run.code == 0, run.said
    assert moved(results, "tiny_diagnosis") == []
