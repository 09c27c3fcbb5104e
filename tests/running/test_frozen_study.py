"""The study of a run is the one that it was started with."""

import os
from pathlib import Path
from typing import Any

import pytest

from pyrofit.config import Study, as_study, read_mapping, read_study
from pyrofit.errors import StudyError
from pyrofit.running.frozen import FROZEN, changed_places, freeze, frozen_study

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Study:
    """Return a study that a run has just frozen."""
    monkeypatch.setenv(FROZEN, "")  # so that it is restored at the end
    monkeypatch.chdir(tmp_path)
    study = read_study(SMOKE)
    freeze(study, Path("results/smoke/study.json"))
    return study


def edited(**values: object) -> dict[str, Any]:
    return read_mapping(SMOKE) | values


def test_job_gets_the_frozen_study_whatever_its_file_now_says(study: Study) -> None:
    assert frozen_study(edited(seed=8), "config/smoke.yaml") == study
    assert frozen_study({"name": "now broken"}, "config/smoke.yaml") == study


def test_study_that_somebody_else_wrote_is_refused_by_name(study: Study) -> None:
    told = os.environ[FROZEN]
    freeze(as_study(edited(seed=8), "config/smoke.yaml"), Path("results/smoke/study.json"))
    os.environ[FROZEN] = told
    with pytest.raises(StudyError, match=r"results/smoke/study.json: .* not the study 'smoke'"):
        frozen_study(edited(), "config/smoke.yaml")


def test_where_no_variable_tells_the_run_an_edit_is_refused_with_its_places(study: Study) -> None:
    del os.environ[FROZEN]
    assert frozen_study(edited(), "config/smoke.yaml") == study
    now = edited(seed=8, title="Another")
    with pytest.raises(StudyError, match=r"smoke.yaml: changed while the workflow runs") as error:
        frozen_study(now, "config/smoke.yaml")
    assert ": title, seed. This run is of results/smoke/study.json" in str(error.value)


def test_missing_study_of_a_run_is_told(study: Study) -> None:
    Path("results/smoke/study.json").unlink()
    with pytest.raises(StudyError, match=r"study.json: there is no such study file"):
        frozen_study(edited(), "config/smoke.yaml")


@pytest.mark.parametrize("content", [b"", b"{", b"\xff\x00"])
def test_a_damaged_file_is_written_anew_by_the_next_run(content: bytes, study: Study) -> None:
    path = Path("results/smoke/study.json")
    path.write_bytes(content)
    freeze(study, path)
    assert frozen_study(edited(), "config/smoke.yaml") == study


def test_differences_name_what_is_only_in_one() -> None:
    one, other = {"a": {"b": 1}, "c": None}, {"a": {"b": 1, "d": 2}, "c": {"e": 3}}
    assert list(changed_places(one, other)) == ["a.d", "c"]
