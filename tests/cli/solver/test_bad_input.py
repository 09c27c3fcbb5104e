"""Whatever is wrong, the user is told what, where, why and what to do, and loses nothing."""

import hashlib
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from bad_diagnosis import DIAGNOSIS
from bad_files import FILES_ELSEWHERE, PREPARE, TABLES
from bad_input import FILES, Case
from bad_results import BROKEN_RESULTS, COMMANDS, PLACES
from bad_studies import KEYS, LIMITS, NO_STUDY, PHYSICS, STAGES

from pyrofit.cli import main

CASES = [
    *(*NO_STUDY, *KEYS, *LIMITS, *PHYSICS, *STAGES, *DIAGNOSIS),
    *(*TABLES, *FILES_ELSEWHERE, *PREPARE),
    *(*BROKEN_RESULTS, *PLACES, *COMMANDS),
]
COSTS = ("RMSE", "RANGE")
STEPS = [
    "prepare",
    "kinetics",
    "identify --stage kinetics",
    *(f"imp --cost {cost} --repetition 0" for cost in COSTS),
    *(f"least-squares --cost {cost}" for cost in COSTS),
    *(f"cma-es --cost {cost}" for cost in COSTS),
    "collect",
    *(f"descent --cost {cost}" for cost in COSTS),
    "identify",
    "predict",
]
IN_A_PROCESS = [
    "tabs",
    "parameter twice",
    "decimal comma",
    "text in a column",
    "fit cut off",
    "disk full for the log",
    "unknown command",
]


def run(command: str) -> int:
    """Run a command in this process; return its exit code."""
    try:
        return main(shlex.split(command))
    except SystemExit as ended:
        return int(ended.code or 0)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a valid study, its files, and the results of every step but pictures."""
    folder = tmp_path_factory.mktemp("finished")
    for name, text in FILES.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for step in STEPS:
            name, _, options = step.partition(" ")
            assert run(f"{name} --study study.yaml {options}") == 0
    return folder


@pytest.fixture
def working(finished: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a copy of it as the working folder, far from any measured files."""
    shutil.copytree(finished, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PYROFIT_DATA_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(finished.parent / "cache"))
    return tmp_path


def contents(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_study_that_is_broken_below_is_valid(
    working: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("check study.yaml") == 0
    said = "study.yaml: study 'small' is valid; 4 measured series read; 2 repetitions in all\n"
    assert capsys.readouterr().out == said


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_bad_input_is_told_with_place_rule_and_way_out_and_nothing_is_lost(
    case: Case,
    working: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    if sys.platform != "linux" and re.search(
        "/proc|/dev/full", " ".join((case.command, *case.words))
    ):
        pytest.skip("needs /proc and /dev/full")
    case.broken(monkeypatch)
    before = contents(working)
    code = run(case.command)
    monkeypatch.undo()
    shown = capsys.readouterr()
    assert code == 2, shown.err
    assert shown.out == ""
    for word in case.words:
        assert word in shown.err
    assert "Traceback" not in shown.err
    assert contents(working) == before


def test_names_of_the_cases_are_their_own() -> None:
    names = [case.name for case in CASES]
    assert sorted(names) == sorted(set(names))


@pytest.mark.parametrize("name", IN_A_PROCESS)
def test_bad_input_ends_the_installed_command_with_code_2(
    name: str, working: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = next(case for case in CASES if case.name == name)
    case.broken(monkeypatch)
    before = contents(working)
    command = [str(Path(sys.executable).with_name("pyrofit")), *shlex.split(case.command)]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.returncode == 2
    assert ended.stdout == ""
    for word in case.words:
        assert word in ended.stderr
    assert "Traceback" not in ended.stderr
    assert contents(working) == before


FINE = {
    "byte-order mark": lambda text: "\ufeff" + text,
    "Windows line ends": lambda text: text.replace("\n", "\r\n"),
    "mixed line ends": lambda text: text.replace("\n", "\r\n", 7),
    "no line end at the end": lambda text: text.rstrip("\n"),
}


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("change", FINE.values(), ids=FINE.keys())
def test_what_editors_do_to_files_is_no_mistake(name: str, change, working: Path) -> None:
    (working / name).write_bytes(change(FILES[name]).encode())
    assert run("check study.yaml") == 0


def test_quoted_numbers_are_numbers(working: Path) -> None:
    text = (working / "data/tga.csv").read_text()
    (working / "data/tga.csv").write_text(text.replace("0,450,4.99998", '"0","450","4.99998"'))
    assert run("check study.yaml") == 0


def test_log_that_runs_out_of_room_loses_no_result(
    working: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("pyrofit.cli.command.open_log", lambda path: path.open("w"))
    before = contents(working)
    assert run("kinetics --study study.yaml --log /dev/full") == 0
    said = capsys.readouterr().err
    assert said.count("/dev/full: log cut off here (No space left on device)") == 1
    assert "generation 3 of 3" in said
    assert contents(working) == before
