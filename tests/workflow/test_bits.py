"""The same bits on every processor: whole runs and diagnoses against stored checksums.

After a change that moves results on purpose,

    PYROFIT_WRITE_GOLDEN=1 pytest tests/workflow -k as_stored

stores them again. They are those of `requirements.lock`. Features of AVX-512 cannot be emulated: a
machine without it shows that the code for AVX2 has these bits, and one with it shows both.
"""

from pathlib import Path

import pytest
import yaml
from golden import AVX2, moved
from tiny import ROOT, Project


def test_run_is_as_stored(untouched: Project) -> None:
    assert moved(untouched.root / "results" / "tiny", "tiny") == []


@pytest.mark.parametrize("features", [{}, AVX2], ids=["this_processor", "without_avx512"])
def test_smoke_and_its_diagnosis_are_as_stored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, features: dict[str, str]
) -> None:
    for name, value in features.items():
        monkeypatch.setenv(name, value)
    project = Project.copy(ROOT, tmp_path / "project")
    smoke = (ROOT / "config" / "smoke.yaml").read_text(encoding="utf-8")
    project.write(yaml.safe_load(smoke))
    for targets in ((), ("diagnose",)):
        run = project.snakemake("--cores", "2", *targets)
        assert run.code == 0, run.said
    assert moved(project.root / "results" / "smoke", "smoke") == []
