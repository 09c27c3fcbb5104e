"""The timed model calls of `pyrofit doctor`."""

from pathlib import Path

import pytest

from pyrofit.config import read_study
from pyrofit.doctor import timing
from pyrofit.doctor.finding import Situation

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"


def test_study_is_timed_before_anything_was_computed(tmp_path: Path) -> None:
    compiler, found = timing.duration(Situation(read_study(SMOKE), tmp_path, 2))
    assert (compiler.level, found.level) == ("ok", "ok")
    assert "model calls x" in found.text
    assert list(tmp_path.iterdir()) == []


def test_truth_that_cannot_be_simulated_is_no_fault_of_the_compiler(tmp_path: Path) -> None:
    study = read_study(SMOKE)
    few = study.accuracy.model_copy(update={"most_steps": 100})
    (found,) = timing.duration(Situation(study.model_copy(update={"accuracy": few}), tmp_path, 2))
    assert (found.level, found.subject) == ("error", "time")
    assert "synthetic measurement failed" in found.text


def test_compiler_that_fails_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(problem: object) -> tuple[float, float]:
        raise RuntimeError("no LLVM")

    monkeypatch.setattr(timing, "seconds", fail)
    found = next(timing.duration(Situation(read_study(SMOKE), tmp_path, 2)))
    assert found.level == "error"
    assert "RuntimeError: no LLVM; reinstall with `make .venv/installed`" in found.text
