"""`pyrofit doctor`: each fault has its line, with the way out, before a run starts."""

import importlib.metadata
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from pyrofit import cli
from pyrofit.config import Study, read_study
from pyrofit.doctor import machine, plan, report, slurm, timing
from pyrofit.doctor.finding import Check, ReadyLine, Situation
from pyrofit.doctor.report import check_data
from pyrofit.doctor.timing import Timed, duration, estimate_of
from pyrofit.doctor.whole_run import PartOfRun, processor_s
from pyrofit.estimate.calls import optimiser_calls, sceua_calls
from pyrofit.estimate.problem import Evaluation
from pyrofit.solver.arrays import Status

ROOT = Path(__file__).parents[2]
SMOKE = ROOT / "config" / "smoke.yaml"
PMMA = ROOT / "config" / "pmma.yaml"
SLURM = {"executor": "slurm", "default-resources": {"slurm_partition": "main"}}
SINFO = "#!/bin/sh\necho debug\necho main\n"


@pytest.fixture(scope="module")
def smoke() -> Study:
    return read_study(SMOKE)


def only(check: Check, situation: Situation) -> ReadyLine:
    (finding,) = check(situation)
    return finding


def program(folder: Path, name: str, text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Put a program in the search path."""
    path = folder / name
    path.write_text(text)
    path.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:/usr/bin:/bin")


def test_package_that_is_not_installed_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "PACKAGES", ("numpy", "no-such-package"))
    found = next(machine.check_versions(Situation(None, Path(), 1, ROOT)))
    assert found.level == "error"
    assert "no-such-package is not installed; `make .venv/installed`" in found.text


def test_installed_package_has_no_locked_versions(tmp_path: Path) -> None:
    found = only(machine.check_versions, Situation(None, Path(), 1, tmp_path))
    assert found.level == "ok"
    assert "packages as installed, not as locked" in found.text


def test_other_version_than_the_locked_one_is_a_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = importlib.metadata.version("numpy")
    (tmp_path / "requirements.lock").write_text("numpy==0.1 ; python_version < '3'\n")
    monkeypatch.setattr(machine, "PACKAGES", ("numpy",))
    situation = Situation(None, Path(), 1, tmp_path)
    found = only(machine.check_versions, situation)
    assert found.level == "warning"
    assert f"numpy {here} (locked: 0.1)" in found.text
    with (tmp_path / "requirements.lock").open("a") as lock:
        lock.write(f"numpy=={here} ; python_version >= '3'\n")
    assert only(machine.check_versions, situation).level == "ok"


def test_cache_that_cannot_be_written_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    places = [tmp_path / "file" / "a", tmp_path / "file" / "b"]
    monkeypatch.setattr("pyrofit.compiled.cache.folders", lambda: places)
    found = only(machine.cache, Situation(None, tmp_path, 1))
    assert found.level == "error"
    assert f"{places[1]} (Not a directory)" in found.text
    assert "set NUMBA_CACHE_DIR" in found.text
    places.append(tmp_path / "good")
    assert only(machine.cache, Situation(None, tmp_path, 1)).level == "ok"


def test_more_jobs_than_cores_are_a_warning(smoke: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "available_cores", lambda: 4)
    found = only(machine.check_cores, Situation(smoke, Path(), 9))
    assert (found.level, found.text.endswith("use --cores 4")) == ("warning", True)
    assert only(machine.check_cores, Situation(smoke, Path(), 4)).level == "ok"
    assert only(machine.check_cores, Situation(smoke, Path(), 9, profile=SLURM)).level == "ok"


def test_too_little_memory_is_an_error_with_the_cores_that_fit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(machine, "available_memory", lambda: 2.0e9)
    found = only(machine.memory, Situation(None, Path(), 8))
    assert (found.level, found.text.endswith("use --cores 2")) == ("error", True)
    assert only(machine.memory, Situation(None, Path(), 2)).level == "ok"
    monkeypatch.setattr(machine, "available_memory", lambda: None)
    assert only(machine.memory, Situation(None, Path(), 2)).level == "warning"


def test_too_little_disk_is_an_error(
    smoke: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    situation = Situation(smoke, tmp_path / "results" / "smoke", 1)
    assert only(machine.disk, situation).level == "ok"
    monkeypatch.setattr(machine, "free_bytes", lambda folder: 1e6)
    found = only(machine.disk, situation)
    assert found.level == "error"
    assert found.text.startswith("1 MB free for")
    assert "make room" in found.text
    assert only(machine.disk, Situation(None, tmp_path, 1)).level == "warning"


def test_results_folder_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "results").touch()
    found = only(machine.disk, Situation(None, tmp_path / "results", 1))
    assert found.level == "error"
    assert "results: cannot be written" in found.text


def test_missing_measured_files_are_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYROFIT_DATA_DIR", str(tmp_path))
    found = only(check_data, Situation(read_study(PMMA), tmp_path, 1))
    assert found.level == "error"
    assert "more files of the MaCFP data base are not there; get them with `make data`" in (
        found.text
    )
    assert only(check_data, Situation(None, tmp_path, 1)).level == "warning"
    monkeypatch.setenv("PYROFIT_DATA_DIR", str(tmp_path / "nowhere"))
    assert only(check_data, Situation(None, tmp_path, 1)).level == "error"


def test_wrong_checksum_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = read_study(PMMA)
    for name in study.needs_macfp:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("Time,Mass\n")
    monkeypatch.setenv("PYROFIT_DATA_DIR", str(tmp_path))
    found = only(check_data, Situation(study, tmp_path, 1))
    assert found.level == "error"
    assert "is registered: the file was altered. Delete it and put" in found.text


@pytest.mark.measured
def test_right_measured_files_are_ok() -> None:
    found = only(check_data, Situation(read_study(PMMA), Path(), 1))
    assert found.level == "ok"
    assert "files of the MaCFP data base are right" in found.text


def test_no_slurm_is_silent_without_and_an_error_with_its_profile(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert list(slurm.slurm(Situation(None, Path(), 1))) == []
    found = only(slurm.slurm, Situation(None, Path(), 1, profile=SLURM))
    assert (found.level, found.text.endswith("run on a login node")) == ("error", True)


def test_unknown_partition_is_an_error_with_the_known_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program(tmp_path, "sinfo", SINFO, monkeypatch)
    monkeypatch.setattr(slurm, "PLUGIN", "numpy")
    right = list(slurm.slurm(Situation(None, Path(), 1, profile=SLURM)))
    assert [f.level for f in right] == ["ok", "ok"]
    wrong = SLURM | {"default-resources": ["slurm_partition=compute"]}
    found = next(slurm.slurm(Situation(None, Path(), 1, profile=wrong)))
    assert found.level == "error"
    assert "no partition 'compute'; set slurm_partition to one of debug, main" in found.text


def test_missing_plugin_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program(tmp_path, "sinfo", SINFO, monkeypatch)
    monkeypatch.setattr(slurm, "PLUGIN", "no-such-plugin")
    _, found = slurm.slurm(Situation(None, Path(), 1, profile=SLURM))
    assert found.level == "error"
    assert "pip install .[slurm]" in found.text


def test_slurm_that_does_not_answer_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program(tmp_path, "sinfo", "#!/bin/sh\necho 'cannot contact' >&2\nexit 1\n", monkeypatch)
    used = only(slurm.slurm, Situation(None, Path(), 1, profile=SLURM))
    assert (used.level, "(cannot contact)" in used.text) == ("error", True)
    assert only(slurm.slurm, Situation(None, Path(), 1)).level == "warning"


@pytest.mark.parametrize(
    ("script", "says"),
    [
        ("#!/bin/sh\necho >&2\nexit 1\n", "exit status 1"),
        ("#!/bin/sh\necho 'no route' >&2\nexec sleep 30\n", "(no route)"),
    ],
    ids=["blank line", "no end"],
)
def test_reason_of_slurm_is_text_in_any_case(
    script: str, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program(tmp_path, "sinfo", script, monkeypatch)
    monkeypatch.setattr(slurm, "LONGEST_ANSWER_S", 0.5)
    found = only(slurm.slurm, Situation(None, Path(), 1))
    assert found.level == "warning"
    assert says in found.text


class Bowl:
    """A problem without a simulation: the distance from a point."""

    names = ("a", "b", "c", "d", "e", "f")
    lower, upper = np.zeros(6), np.ones(6)
    picks = ("a",)

    def evaluate_all(self, sets: np.ndarray) -> list[Evaluation]:
        costs = [float(np.sum((x - 0.3) ** 2)) for x in sets]
        return [Evaluation(cost, (cost,), Status.OK) for cost in costs]


def test_planned_calls_and_size_are_those_of_a_search(smoke: Study, tmp_path: Path) -> None:
    from pyrofit.estimate.sceua import search
    from pyrofit.results.files import write_csv

    history = search(Bowl(), 3, 12)  # type: ignore[arg-type]
    settings = smoke.imp.sceua.model_copy(update={"generations": 12, "complexes": None})
    stage = smoke.imp.model_copy(update={"sceua": settings, "estimate": Bowl.names})
    assert sceua_calls(stage) == pytest.approx(len(history), rel=0.15)
    write_csv(tmp_path / "h.csv.gz", history)
    planned = plan.BYTES_PER_NUMBER * 7 * sceua_calls(stage)
    assert planned == pytest.approx((tmp_path / "h.csv.gz").stat().st_size, rel=0.25)


@pytest.mark.parametrize(("cores", "jobs"), [(None, 1 + 3), (2, 1), (6, 1 + 3)])
def test_jobs_are_grouped_as_the_workflow_groups_them(
    smoke: Study, cores: int | None, jobs: int
) -> None:
    stage = smoke.imp.model_copy(update={"repetitions": 19})
    first, *costs = plan.parts_of(smoke.model_copy(update={"imp": stage}), cores)
    assert (first.cost, first.jobs) == ("", 1)
    assert [c.jobs for c in costs] == [jobs + 2] * 3


def test_duration_is_that_of_steps_alone_and_of_the_others_over_cores() -> None:
    part = plan.PartOfSearches("RMSE", alone=1000.0, together=3000.0, jobs=10, exact=200.0)
    beside = [PartOfRun(7.0, alone=True), PartOfRun(4.0, jobs=2)]
    fit = Timed(part, alone=0.02, together=0.01, exact=0.05)
    found = estimate_of(Situation(None, Path(), 2), [fit], beside, 3.0)
    assert found.level == "ok"
    # The searches: 2 (1000 x 0.02 s + 3000 x 0.01 s + 200 x 0.05 s) = 120 s.
    # Alone 7 s + 3 s; the others 120 s + 4 s + 12 x 3 s = 160 s.
    assert found.text.startswith(
        "about 90 s for the run on 2 cores. 4,200 model calls x 14 ms are for the searches, 11 s "
        "for their analysis and figures, 13 x 3 s to begin a step."
    )
    slow = estimate_of(Situation(None, Path(), 2), [Timed(part, 20.0, 40.0, 40.0)], beside, 3.0)
    assert (slow.level, "docs/cluster.md" in slow.text) == ("warning", True)


def test_duration_tells_how_much_longer_it_is_beside_other_work() -> None:
    fit = Timed(plan.PartOfSearches("RMSE", alone=0.0, together=6000.0, jobs=2), 0.01, 0.01, 0.01)
    situation = Situation(None, Path(), 2)
    told = {slower: estimate_of(situation, [fit], [], 0.0, slower).text for slower in (1.1, 4.0)}
    assert told[1.1].startswith("about 60 s for the run on 2 cores. 6,000")
    assert told[4.0].startswith("about 60 s for the run on 2 cores, 4 min beside the work of now. ")


def test_processor_time_counts_own_and_started_work_only() -> None:
    begin = processor_s()
    time.sleep(0.2)
    assert processor_s() - begin < 0.1
    subprocess.run([sys.executable, "-c", "sum(range(3_000_000))"], check=True)
    assert processor_s() - begin > 0.02


def test_searches_are_timed_with_their_coarser_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    part = plan.PartOfSearches("RMSE", alone=1.0, together=1.0, jobs=1, exact=1.0)
    times = {"own": (8.0, 4.0), "coarser": (2.0, 1.0)}
    monkeypatch.setattr(timing, "seconds", times.__getitem__)
    monkeypatch.setattr(timing, "for_search", lambda problem: "coarser")
    assert timing.timed_part(part, "own") == Timed(part, 2.0, 1.0, exact=4.0)
    monkeypatch.setattr(timing, "for_search", lambda problem: problem)
    assert timing.timed_part(part, "own") == Timed(part, 8.0, 4.0, exact=4.0)


def test_searches_that_need_slopes_are_never_coarser(smoke: Study) -> None:
    first, *costs = plan.parts_of(smoke, 2)
    assert first.exact == 0.0
    needing_slopes = optimiser_calls(smoke.imp, "least_squares")
    assert [c.exact for c in costs] == [needing_slopes] * 3


def test_external_programs_are_left_to_the_trial() -> None:
    study = read_study(ROOT / "config" / "hotplate.yaml")
    found = only(duration, Situation(study, Path(), 1))
    assert found.level == "warning"
    assert "`pyrofit trial --study" in found.text


def good(situation: Situation) -> Iterator[ReadyLine]:
    yield ReadyLine("ok", "some", "thing")


def bad(situation: Situation) -> Iterator[ReadyLine]:
    yield ReadyLine("error", "other", "thing")


def test_status_is_1_on_an_error_alone(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(report, "CHECKS", [good])
    assert cli.main(["doctor", str(SMOKE)]) == 0
    assert capsys.readouterr().out.splitlines()[0] == "ok       study     'smoke' is valid"
    monkeypatch.setattr(report, "CHECKS", [bad, good])
    assert cli.main(["doctor", str(SMOKE)]) == 1
    assert len(capsys.readouterr().out.splitlines()) == 3


def test_wrong_study_is_an_error_and_the_machine_is_checked_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(report, "CHECKS", [good])
    assert cli.main(["doctor", str(tmp_path / "none.yaml")]) == 1
    first, second = capsys.readouterr().out.splitlines()
    assert first.startswith("error    study")
    assert second == "ok       some      thing"


def test_profile_gives_the_jobs_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    seen: list[Situation] = []

    def look(situation: Situation) -> Iterator[ReadyLine]:
        seen.append(situation)
        return iter(())

    monkeypatch.setattr(report, "CHECKS", [look])
    assert cli.main(["doctor", "--profile", str(ROOT / "profiles" / "slurm")]) == 0
    assert seen[0].on_slurm
    assert seen[0].cores == seen[0].profile["jobs"]
    assert cli.main(["doctor", "--profile", str(tmp_path)]) == 2
    assert "there is no such profile; name its folder" in capsys.readouterr().err
    shutil.copytree(ROOT / "profiles", tmp_path / "profiles")
    monkeypatch.chdir(tmp_path)
    assert cli.main(["doctor"]) == 0
    assert (seen[1].cores, seen[1].on_slurm) == (2, False)
