"""Files of inputs change with what a step depends on; jobs take the study of their run."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from pyrofit.config import Study, as_study, read_mapping
from pyrofit.errors import RUN, StudyError
from pyrofit.results import dependencies
from pyrofit.running.lock import RunError, start_run
from pyrofit.running.plan import STUDY_OF_RUN, InputFiles, named_study, study_of_run

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
ROOT = Path("results/smoke")
CODE = "pyrofit.seeds"
ALIVE = "results/smoke: a run of this study is alive; steps are planned as it knows them\n"
SLICES: dict[str, Callable[[Study], dict[str, object]]] = {
    "collect": dependencies.collect_slice,
    "report": dependencies.presentation,
}
"""The one depends on the number of repetitions, the other on everything."""


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in (STUDY_OF_RUN, RUN):
        monkeypatch.setenv(name, "")  # so that it is restored at the end
        monkeypatch.delenv(name)
    monkeypatch.chdir(tmp_path)


def study(**values: object) -> Study:
    return as_study(given(**values), "config/smoke.yaml")


def given(**values: object) -> dict[str, Any]:
    return read_mapping(SMOKE) | values


def plan(code: str = CODE, **values: object) -> InputFiles:
    """Plan two steps of the study with some values changed."""
    files = InputFiles(study(**values), ROOT)
    for step, slice_of in SLICES.items():
        assert files(step, slice_of, code) == ROOT / "inputs" / f"{step}.json"
    return files


def written() -> dict[str, tuple[bytes, int]]:
    """Return content and time of each file of inputs."""
    paths = (ROOT / "inputs").iterdir()
    return {path.stem: (path.read_bytes(), path.stat().st_mtime_ns) for path in paths}


def changed(before: dict[str, tuple[bytes, int]]) -> set[str]:
    return {step for step, now in written().items() if now != before[step]}


def test_file_is_written_anew_only_where_the_step_uses_what_changed() -> None:
    plan()
    before = written()
    assert before.keys() == SLICES.keys()
    plan()
    assert changed(before) == set()
    plan(title="Another")
    assert changed(before) == {"report"}
    plan(imp=given()["imp"] | {"repetitions": 3})
    assert changed(before) == {"collect", "report"}


def test_edit_that_is_taken_back_leaves_the_content_whatever_else_was_edited() -> None:
    plan()
    before = written()
    imp = given()["imp"]
    plan(title="Another", imp=imp | {"repetitions": 3})
    plan(title="Another")
    assert written()["collect"][0] == before["collect"][0]


def test_other_code_is_another_content() -> None:
    plan()
    before = written()
    plan(code="pyrofit.constants")
    assert changed(before) == {*SLICES}


def test_file_of_inputs_names_the_study_that_the_run_began_with() -> None:
    plan().begin()
    named = named_study(ROOT / "inputs" / "collect.json")
    assert named == ROOT / "study.json"
    assert as_study(read_mapping(named), str(named)) == study()
    assert named_study(named) is None
    assert named_study(SMOKE) is None


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"{}", b"\xff\x00"])
def test_file_that_is_damaged_is_written_anew(content: bytes) -> None:
    plan().begin()
    for path in (ROOT / "study.json", ROOT / "inputs" / "collect.json"):
        path.write_bytes(content)
        assert named_study(path) is None
    plan().begin()
    assert named_study(ROOT / "inputs" / "collect.json") == ROOT / "study.json"
    assert study_of_run({"name": "smoke"}) == study()


def test_plan_beside_a_run_changes_none_of_its_files(capsys: pytest.CaptureFixture[str]) -> None:
    plan().begin()
    (ROOT / "inputs" / "report.json").unlink()
    start_run(ROOT)
    before = written()
    plan(seed=8, imp=given()["imp"] | {"repetitions": 3})
    assert written().items() >= before.items()
    assert "report" in written()  # of a step that the run does not have
    assert capsys.readouterr().err == ALIVE
    (ROOT / "running" / "run.json").unlink()


def test_run_does_not_begin_where_another_study_was_planned_since() -> None:
    mine = plan()
    plan(seed=8)
    with pytest.raises(RunError, match=r"report\.json: changed while this run was planned"):
        mine.begin()
    assert not (ROOT / "study.json").exists()


def test_job_of_a_cluster_takes_files_and_study_as_they_are() -> None:
    plan().begin()
    before = written()
    job = InputFiles(study(seed=8), ROOT, as_they_are=True)
    assert job("report", dependencies.presentation, CODE).is_file()
    assert changed(before) == set()
    assert study_of_run(given(seed=8, name="other")) == study()


def test_where_no_variable_tells_the_run_its_study_has_the_name_of_the_file() -> None:
    plan().begin()
    del os.environ[STUDY_OF_RUN]
    assert study_of_run(given(seed=8)) == study()
    with pytest.raises(StudyError, match=r"results/other/study\.json: there is no such study file"):
        study_of_run({"name": "other"})
