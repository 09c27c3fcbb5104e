"""Runs of external programs: judged, kept, ended in time, and never run twice."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from decay import fake_fds, study, write

from pyrofit.config import Study, as_study
from pyrofit.config.expand.programs import externals, keeping_runs
from pyrofit.errors import ProgramError, StudyError
from pyrofit.estimate.problem import FAILED_COST, Problem, make_problem
from pyrofit.external import scratch as scratch_module
from pyrofit.external.filled import filled_input
from pyrofit.external.runs import Outcome, outcomes
from pyrofit.external.scratch import PREFIX, scratch, sweep_scratch
from pyrofit.quantities import known_quantities
from pyrofit.results.files import Results
from pyrofit.solver.arrays import Status
from pyrofit.stages.diagnose import diagnose_study
from pyrofit.stages.measurements import computed, prepare
from pyrofit.stages.trial import trial

CLI = "import sys; from pyrofit.cli import main; sys.exit(main())"
CONFIG = Path(__file__).parents[3] / "config"
SUPPORT = str(Path(__file__).parents[2] / "support")


@pytest.fixture(autouse=True)
def _scratch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYROFIT_SCRATCH", str(tmp_path / "scratch"))
    monkeypatch.setenv("RUNS", str(tmp_path / "runs.txt"))
    monkeypatch.delenv("PYROFIT_FDS", raising=False)


def opened(folder: Path, mode: str = "well", **program: Any) -> Study:
    """Return the study with its program in a folder with a space."""
    mine = folder / "my study"
    write(mine, mode)
    found = as_study(study(**program), str(mine / "study.yaml"))
    return keeping_runs(found, folder / "programs")


def run(found: Study, *sets: tuple[float, float], needed: float = 98.0) -> list[Outcome]:
    experiment = externals(found)["plate"]
    values = [{"height": h, "fall": f} for h, f in sets]
    quantities = {"mlr": known_quantities()["mlr"]}
    return outcomes(experiment.program, quantities, {"mlr": needed}, values)


def runs(folder: Path) -> list[str]:
    path = folder / "runs.txt"
    return path.read_text().splitlines() if path.exists() else []


def failures(folder: Path) -> list[dict[str, Any]]:
    found = sorted((folder / "programs" / "plate" / "failed").glob("*.json"))
    return [json.loads(path.read_text()) for path in found]


def test_a_run_gives_the_curve_and_leaves_nothing_behind(tmp_path: Path) -> None:
    (found,) = run(opened(tmp_path), (9.0, 0.02))
    assert found.why == ""
    expected = 9e-3 * np.exp(-0.02 * np.arange(101))
    assert found.records["mlr"].value == pytest.approx(expected, rel=1e-10)
    assert list((tmp_path / "scratch").iterdir()) == []


def test_a_set_is_run_once_and_read_with_the_same_bits(tmp_path: Path) -> None:
    first = run(opened(tmp_path), (9.0, 0.02), (9.0, 0.02), (8.0, 0.02))
    again = run(opened(tmp_path), (8.0, 0.02), (9.0, 0.02))
    assert runs(tmp_path) == ["9.0 0.02", "8.0 0.02"]
    values = [one.records["mlr"].value.tobytes() for one in (*first, *again)]
    assert values[0] == values[1] == values[4]
    assert values[2] == values[3]


def test_several_runs_at_once_have_the_bits_of_one_after_the_other(tmp_path: Path) -> None:
    sets = [(9.0, 0.01 * n) for n in range(1, 6)]
    one = run(opened(tmp_path / "a"), *sets)
    several = run(opened(tmp_path / "b", parallel=3), *sets)
    for x, y in zip(one, several, strict=True):
        assert x.records["mlr"].value.tobytes() == y.records["mlr"].value.tobytes()


FAILURES = {
    "exit status": ("fails above 0.04", {}, "exit status 3"),
    "signal": ("dies", {}, "it was ended by signal 11"),
    "no output": ("silent", {}, "rate.csv: the program has not written it"),
    "ends early": ("short", {}, "mlr ends at 49, and is needed until 98"),
    "cut": ("cut", {}, "mlr ends at 5"),
    "not finite": ("infinite", {}, "no finite number"),
    "says so": ("says", {"fails": "^ERROR.*"}, "it says 'ERROR: no convergence'"),
    "does not say so": ("well", {"succeeds": "all is well"}, "it does not say 'all is well'"),
}


@pytest.mark.parametrize(("mode", "program", "why"), FAILURES.values(), ids=FAILURES)
def test_a_failure_is_recorded_and_not_run_again(
    mode: str, program: dict[str, Any], why: str, tmp_path: Path
) -> None:
    (found,) = run(opened(tmp_path, mode, **program), (9.0, 0.05))
    assert why in found.why, found.why
    assert found.records == {}
    (record,) = failures(tmp_path)
    assert record["why"] == found.why
    assert record["placeholders"]["fall"] == {"value": 0.05, "unit": "1/s"}
    kept = tmp_path / "programs" / "plate" / "failed" / record["folder"]
    assert "fall = 0.05" in (kept / "decay.inp").read_text()
    if mode == "fails above 0.04":
        assert record["exit_status"] == 3
        assert record["last_lines"] == ["the step became too small"]
    (again,) = run(opened(tmp_path, mode, **program), (9.0, 0.05))
    assert again.why == found.why
    assert len(runs(tmp_path)) == 1


@pytest.mark.parametrize(
    ("mode", "why"),
    [("killed once", ""), ("killed", "it was killed twice, perhaps for lack of memory")],
)
def test_a_killed_run_is_repeated_once(
    mode: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("KILLED", str(tmp_path / "killed"))
    (found,) = run(opened(tmp_path, mode), (9.0, 0.02))
    assert found.why == why
    assert len(runs(tmp_path)) == 2
    assert bool(failures(tmp_path)) == bool(why)


@pytest.mark.parametrize(
    ("mode", "says"),
    [("ended from outside", "from outside by signal 15"), ("no program", "cannot be started")],
)
def test_what_tells_nothing_of_the_set_stops_the_step_and_is_not_kept(
    mode: str, says: str, tmp_path: Path
) -> None:
    found = opened(tmp_path, mode)
    if mode == "no program":
        nothing = tmp_path / "my study" / "nothing"
        nothing.write_bytes(b"\x00")
        nothing.chmod(0o755)
        found = opened(tmp_path, command="./nothing x")
    with pytest.raises(ProgramError, match=says):
        run(found, (9.0, 0.02))
    assert failures(tmp_path) == []


def test_no_more_folders_of_failures_are_kept_than_asked_for(tmp_path: Path) -> None:
    found = opened(tmp_path, "fails above 0.04", keep_failed=2)
    run(found, *((9.0, 0.05 + 0.001 * n) for n in range(4)))
    assert sum(record["folder"] is not None for record in failures(tmp_path)) == 2
    assert len(failures(tmp_path)) == 4


def test_a_run_beyond_the_time_limit_is_killed_with_its_children(tmp_path: Path) -> None:
    begin = time.monotonic()
    (found,) = run(opened(tmp_path, "hangs", time_limit_s=0.5), (9.0, 0.02))
    assert found.why == "it did not end within 0.5 s"
    assert time.monotonic() - begin < 10.0
    assert not processes_left_in(tmp_path)
    write(tmp_path / "my study")
    assert failures(tmp_path)[0]["time_limit_s"] == 0.5


@pytest.mark.slow
def test_a_set_that_was_too_slow_is_run_again_with_more_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SLOW", "4")
    assert run(opened(tmp_path, time_limit_s=3), (9.0, 0.02))[0].why
    assert run(opened(tmp_path, time_limit_s=2), (9.0, 0.02))[0].why
    assert len(runs(tmp_path)) == 1
    assert not run(opened(tmp_path, time_limit_s=20), (9.0, 0.02))[0].why
    assert failures(tmp_path) == []


def processes_left_in(folder: Path) -> list[int]:
    """Return the processes whose working folder lies below one and that do not end soon.

    A killed process may need a moment to end.
    """
    until = time.monotonic() + 5.0
    while (found := _processes_in(folder)) and time.monotonic() < until:
        time.sleep(0.05)
    return found


def _processes_in(folder: Path) -> list[int]:
    """Return the processes whose working folder lies below one."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if os.readlink(process / "cwd").startswith(str(folder)):
                found.append(int(process.name))
        except OSError:
            continue
    return found


def test_what_a_killed_process_left_is_ended_and_removed(tmp_path: Path) -> None:
    script = (
        "import sys, time, subprocess; from pyrofit.external.scratch import scratch\n"
        "with scratch() as folder:\n"
        "    subprocess.Popen(['sleep', '60'], cwd=folder, start_new_session=True)\n"
        "    print('ready', flush=True); time.sleep(60)\n"
    )
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.readline()
        with scratch() as mine:
            assert sweep_scratch() == 0  # their owners live
            process.send_signal(signal.SIGKILL)
            process.wait()
            assert sweep_scratch() == 1
            assert mine.is_dir()
    time.sleep(0.1)
    assert not processes_left_in(tmp_path / "scratch")
    assert not list((tmp_path / "scratch").glob(f"{PREFIX}*"))


def test_a_folder_is_locked_before_another_process_can_find_it_free(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lock = scratch_module.fcntl.flock
    swept = []

    def sweep_first(file: Any, kind: int) -> None:
        if not swept:
            swept.append(0)
            swept[0] = sweep_scratch()
        lock(file, kind)

    monkeypatch.setattr(scratch_module.fcntl, "flock", sweep_first)
    with scratch() as folder:
        assert swept == [0]
        assert folder.is_dir()


def test_a_scratch_folder_that_cannot_be_written_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("PYROFIT_SCRATCH", str(tmp_path / "file"))
    with pytest.raises(ProgramError, match=r"file: cannot be written .*PYROFIT_SCRATCH"):
        run(opened(tmp_path), (9.0, 0.02))


@pytest.mark.parametrize("content", [b"", b"cut", "middle"])
def test_a_damaged_file_of_a_run_is_made_anew(content: Any, tmp_path: Path) -> None:
    found = opened(tmp_path)
    first = run(found, (9.0, 0.02))
    (kept,) = (tmp_path / "programs" / "plate" / "runs").glob("*/*.gz")
    whole = kept.read_bytes()
    if content == "middle":
        content = whole[:100] + b"\xff" * 50 + whole[150:]
    kept.write_bytes(content)
    second = run(found, (9.0, 0.02))
    assert second[0].records["mlr"].value.tobytes() == first[0].records["mlr"].value.tobytes()
    run(found, (9.0, 0.02))
    assert len(runs(tmp_path)) == 2
    assert kept.stat().st_mode & 0o044 == 0o044  # for colleagues
    assert not list(kept.parent.glob(".*"))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_ends_the_program_and_keeps_no_failure(
    number: signal.Signals, tmp_path: Path
) -> None:
    mine = tmp_path / "mine"
    write(mine, "hangs")
    (mine / "study.yaml").write_text(yaml.safe_dump(study()))
    with subprocess.Popen(
        [sys.executable, "-c", CLI, "prepare", "--study", "mine/study.yaml"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
    ) as process:
        give_up = time.monotonic() + 60.0
        while not runs(tmp_path):
            assert time.monotonic() < give_up
            time.sleep(0.05)
        process.send_signal(number)
        _, said = process.communicate()
    assert process.returncode == 130
    assert b"run again to go on" in said
    assert not processes_left_in(tmp_path / "scratch")
    assert not list(tmp_path.glob("results/*/programs/*/failed/*.json"))


def test_an_interruption_ends_all_runs_at_once_and_keeps_no_failure(tmp_path: Path) -> None:
    mine = tmp_path / "mine"
    write(mine, "hangs")
    (mine / "study.yaml").write_text(yaml.safe_dump(study(parallel=3)))
    script = (
        f"import sys; sys.path.insert(0, {SUPPORT!r})\n"
        "from pathlib import Path; from pyrofit.config import read_study\n"
        "from pyrofit.config.expand.programs import externals, keeping_runs\n"
        "from pyrofit.external.runs import outcomes\n"
        "from pyrofit.quantities import known_quantities\n"
        "found = keeping_runs(read_study(Path('mine/study.yaml')), Path('programs'))\n"
        "sets = [{'height': 9.0, 'fall': 0.01 * n} for n in range(1, 6)]\n"
        "quantities = {'mlr': known_quantities()['mlr']}\n"
        "outcomes(externals(found)['plate'].program, quantities, {}, sets)\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script], cwd=tmp_path, stderr=subprocess.PIPE
    ) as process:
        give_up = time.monotonic() + 60.0
        while len(runs(tmp_path)) < 3:
            assert time.monotonic() < give_up
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=20)
    assert b"KeyboardInterrupt" in said
    assert not processes_left_in(tmp_path / "scratch")
    assert len(runs(tmp_path)) == 3
    assert not list(tmp_path.glob("programs/*/failed/*.json"))


MISSING = {
    "on the path": ("decayed x", "there is no program 'decayed' on the PATH"),
    "path": ("./nowhere/decayed x", "is no executable file"),
}


@pytest.mark.parametrize(("command", "says"), MISSING.values(), ids=MISSING)
def test_a_missing_program_stops_the_step(command: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(ProgramError, match=says):
        run(opened(tmp_path, command=command), (9.0, 0.02))


def test_a_program_beside_the_study_is_found(tmp_path: Path) -> None:
    script = write(tmp_path / "my study")
    script.write_text(f"#!{sys.executable}\n" + script.read_text())
    script.chmod(0o755)
    mine = tmp_path / "my study" / "study.yaml"
    found = as_study(study(command="decay.py decay.inp", files=[]), str(mine))
    assert run(found, (9.0, 0.02))[0].why == ""


def test_a_program_of_the_home_folder_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    (tmp_path / "home").mkdir()
    program = tmp_path / "home" / "program"
    program.write_text("#!/bin/sh\nexec python3 -S decay.py decay.inp\n")
    program.chmod(0o755)
    assert run(opened(tmp_path, command="~/program"), (9.0, 0.02))[0].why == ""


def test_a_program_goes_by_the_name_of_its_link(tmp_path: Path) -> None:
    found = opened(tmp_path, command="./by_link x")
    folder = tmp_path / "my study"
    (folder / "program").write_text(
        "#!/bin/sh\ncase $0 in *by_link) python3 -S decay.py decay.inp;; *) exit 4;; esac\n"
    )
    (folder / "program").chmod(0o755)
    (folder / "by_link").symlink_to("program")
    assert run(found, (9.0, 0.02))[0].why == ""


# --- the same costs and optimisers ----------------------------------------------------------


def problem(found: Study) -> Problem:
    specs = found.imp.costs["RMSE"]
    return make_problem(found, found.imp.estimate, specs, computed(found), found.material, {})


def test_a_failed_run_costs_more_than_any_other_and_the_search_goes_on(tmp_path: Path) -> None:
    posed = problem(opened(tmp_path, "fails above 0.04"))
    well, failed = posed.evaluate_all(np.array([[12.0, 0.03], [12.0, 0.05]]))
    assert 0.0 < well.cost < 3e-4
    assert failed.cost == FAILED_COST
    assert failed.status == Status.PROGRAM_FAILED


def test_delay_and_offset_of_the_record_count(tmp_path: Path) -> None:
    given = study()
    given["experiments"]["plate"]["signals"]["mlr"] |= {"delay_s": 10.0, "offset": 0.5}
    write(tmp_path)
    found = as_study(given, str(tmp_path / "study.yaml"))
    _, (curve,) = problem(found).simulate(np.array([12.0, 0.03]))
    times = np.arange(2.5, 98.0, 5.0)
    expected = 0.5 + 0.012 * np.exp(-0.03 * np.maximum(times - 10.0, 0.0))
    assert curve == pytest.approx(expected, rel=1e-3)


def test_what_a_campaign_costs_is_said_before_it_starts(tmp_path: Path) -> None:
    found = opened(tmp_path)
    results = Results(tmp_path)
    prepare(found, results)
    one, total = trial(found, results, cores=2)
    assert one.startswith("plate: one run of python")
    assert "model calls" in total
    assert "on 2" in total
    kept = json.loads(results.programs("trial.json").read_text())
    # 10 points and 3 generations of 1.63 as many, two repetitions.
    assert kept["calls"]["SCE-UA, RMSE"] == round(2 * 10 * (1 + 1.63 * 3))
    assert kept["experiments"]["plate"]["files"].keys() == {
        str(tmp_path / "my study" / name) for name in ("decay.inp", "decay.py")
    }
    assert kept["core_hours"] > 0.0


def test_a_program_that_always_fails_stops_before_the_campaign(tmp_path: Path) -> None:
    found = opened(tmp_path)
    results = Results(tmp_path)
    prepare(found, results)
    with pytest.raises(ProgramError, match=r"the program fails: rate\.csv: the program has not"):
        trial(opened(tmp_path, "silent"), results, cores=1)


def test_the_diagnosis_refuses_a_model_that_is_not_its_own(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match="an external program has a model of its own"):
        diagnose_study(opened(tmp_path), Results(tmp_path), print)


# --- FDS and Gpyro --------------------------------------------------------------------------


def shipped(name: str, signals: tuple[str, ...] = ("capa_25", "capa_60")) -> Study:
    """Return a shipped study with computed measurements in place of the measured ones."""
    given = yaml.safe_load((CONFIG / f"{name}.yaml").read_text(encoding="utf-8"))
    for experiment in signals:
        described = given["experiments"][experiment]
        described["duration_s"] = 300
        described["signals"] = {
            signal: {"file": "synthetic", "every": 10, "noise": 1e-9}
            for signal in described["signals"]
        }
    parameters = given["parameters"].items()
    middle = {n: 0.5 * (p["lower"] + p["upper"]) for n, p in parameters if "lower" in p}
    given["synthetic"] = {"truth": middle}
    return as_study(given, str(CONFIG / f"{name}.yaml"))


def test_fds_is_found_run_and_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYROFIT_FDS", str(fake_fds(tmp_path / "a folder", "well")))
    monkeypatch.setenv("SECRET", "1")
    found = keeping_runs(shipped("paper_fds"), tmp_path / "programs")
    frame = computed(found)["capa_25", "mlr"]
    assert frame["mlr_kg_m2_s"].to_numpy() == pytest.approx(0.01 + 0.05 * 0.22, rel=1e-6)
    back = computed(found)["capa_60", "back_temperature"]
    # The mean over the second before stands for its middle.
    assert back["back_temperature_K"].iloc[0] == pytest.approx(273.15 + 20 + 0.1 * 5.5, rel=1e-6)
    results = Results(tmp_path)
    prepare(found, results)
    assert trial(found, results, 1)[0].startswith("capa_25: one run of fds 6.7.4 takes")


@pytest.mark.parametrize(
    ("mode", "why"),
    [
        ("error", "ERROR: Problem with SURF number 1, line 30"),
        ("stopped", "exit status 0"),
        ("truncated", "needed until 295"),
    ],
)
def test_fds_that_fails_with_exit_status_0_has_failed(
    mode: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYROFIT_FDS", str(fake_fds(tmp_path / "bin", mode)))
    experiment = externals(keeping_runs(shipped("paper_fds"), tmp_path))["capa_60"]
    quantities = {s: experiment.quantity(s) for s in experiment.program.reads}
    truth = shipped("paper_fds").true_values()
    needed = dict.fromkeys(quantities, 295.0)
    (found,) = outcomes(experiment.program, quantities, needed, [truth])
    assert why in found.why


def test_without_fds_it_is_said_how_to_name_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ProgramError, match="no FDS found; set PYROFIT_FDS"):
        computed(shipped("paper_fds"))


def test_the_input_of_gpyro_is_filled_in_its_units(tmp_path: Path) -> None:
    found = shipped("pmma_gpyro")
    monkey = tmp_path / "gpyro"
    monkey.write_text("#!/bin/sh\n")
    monkey.chmod(0o755)
    program = externals(found)["capa_25"].program
    program = program.model_copy(update={"command": (str(monkey), "pmma.data")})
    text = filled_input(program, found.true_values()).content.decode()
    assert "C0(1) = 2250.0" in text
    assert "DHV(1) = 850000.0" in text
    assert "E(1) = 188.0" in text
    rate = float(text.split("\nZ(1) = ")[1].split(",")[0])
    assert rate * np.exp(-188e3 / (8.314 * 615.0)) == pytest.approx(1e-3, rel=1e-12)
    assert "#" not in text
