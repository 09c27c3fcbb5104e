"""The command line."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pyrofit import cli
from pyrofit.errors import DataError

ROOT = Path(__file__).parents[2]
SMOKE = ROOT / "config" / "smoke.yaml"
STEPS = ["prepare", "kinetics", "imp", "least-squares", "cma-es", "collect", "predict"]
SHOWS = ["show", "report"]


def test_module_of_the_command_line_imports_nothing_slow() -> None:
    slow = "{'numpy', 'pandas', 'numba', 'scipy', 'spotpy', 'matplotlib', 'pydantic'}"
    code = f"import sys, pyrofit.cli; print(sorted({slow} & set(sys.modules)))"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert shown.stdout.strip() == "[]"


def test_help_of_the_installed_command_lists_every_command() -> None:
    command = Path(sys.executable).with_name("pyrofit")
    shown = subprocess.run([command, "--help"], capture_output=True, text=True, check=True)
    assert shown.stderr == ""
    for name in (*STEPS, *SHOWS, "data", "check"):
        assert f"\n    {name}" in shown.stdout


@pytest.mark.parametrize("name", [*STEPS, *SHOWS])
def test_help_of_a_step_explains_its_options(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main([name, "--help"])
    assert ended.value.code == 0
    shown = capsys.readouterr().out
    for option in ("--study", "--results", "--log"):
        assert option in shown


def test_unknown_command_ends_with_code_2(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(["calibrate"])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert "there is no command 'calibrate'" in said
    assert "pyrofit run STUDY" in said
    assert "choose from" not in said


@pytest.mark.parametrize("files", [["a.csv"], ["a.csv", "--tga", "b.csv"]])
def test_files_without_their_kind_end_with_the_names_of_the_kinds(
    files: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["init", "mine", *files]) == 2
    said = capsys.readouterr().err
    assert "a.csv: the kind of its test is not given" in said
    assert "--mcc" in said


def test_check_says_what_the_study_will_do(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["check", str(SMOKE)]) == 0
    said = "study 'smoke' is valid; 0 measured series read; 6 repetitions in all"
    assert said in capsys.readouterr().out


@pytest.mark.parametrize("name", STEPS[1:])
def test_step_before_its_time_says_what_is_missing(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cost = ["--cost", "RMSE"]
    options = {"imp": [*cost, "--repetition", "0", "1"], "least-squares": cost, "cma-es": cost}
    given = [name, "--study", str(SMOKE), "--results", str(tmp_path), *options.get(name, [])]
    assert cli.main(given) == 2
    said = capsys.readouterr().err
    assert "this result is missing; run the workflow to make it" in said
    assert "Traceback" not in said


def test_unknown_cost_is_told_with_the_known_ones(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["--study", str(SMOKE), "--results", str(tmp_path), "--cost", "RMSW"]
    assert cli.main(["least-squares", *given]) == 2
    said = capsys.readouterr().err
    assert "no cost 'RMSW'. Did you mean 'RMSE'? Known: BANDS, RANGE, RMSE." in said


def test_error_is_kept_in_the_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "logs" / "collect.log"
    given = ["collect", "--study", str(tmp_path / "none.yaml"), "--log", str(log)]
    assert cli.main(given) == 2
    assert log.read_text() == capsys.readouterr().err != ""


def test_log_that_cannot_be_written_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["collect", "--study", str(SMOKE), "--log", str(tmp_path)]
    assert cli.main(given) == 2
    assert f"error: {tmp_path}: cannot be written" in capsys.readouterr().err


def test_interruption_ends_with_code_130(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupt(path: Path) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("pyrofit.config.read_study", interrupt)
    assert cli.main(["check", str(SMOKE)]) == 130
    assert "interrupted; run again to go on" in capsys.readouterr().err


def test_interruption_while_modules_are_loaded_is_one_line() -> None:
    code = """
import os, signal, sys
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "pyrofit.cli.fitting":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Finder())
from pyrofit.cli import main
sys.exit(main(["check", "none.yaml"]))
"""
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 130
    assert ended.stderr == "interrupted; run again to go on, finished parts are kept\n"


def test_second_signal_does_not_break_off_the_answer_to_the_first(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    cleaned = []

    def interrupt(path: Path) -> None:
        try:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)
        finally:
            os.kill(os.getpid(), signal.SIGTERM)
            cleaned.append(path)

    monkeypatch.setattr("pyrofit.config.read_study", interrupt)
    before = signal.getsignal(signal.SIGINT)
    assert cli.main(["check", str(SMOKE)]) == 130
    assert len(cleaned) == 1
    assert signal.getsignal(signal.SIGINT) is before


def test_fault_of_the_program_is_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(path: Path) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("pyrofit.config.read_study", fail)
    with pytest.raises(ZeroDivisionError):
        cli.main(["check", str(SMOKE)])


def test_place_of_the_measured_files_is_printed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setattr("pyrofit.data.fetch.store", lambda: tmp_path)
    monkeypatch.setattr("pyrofit.data.fetch.missing", lambda folder: [])
    assert cli.main(["data", "where"]) == 0
    assert capsys.readouterr().out == f"{tmp_path}\n"


def test_missing_measured_files_are_told_with_the_way_out(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setattr("pyrofit.data.fetch.store", lambda: tmp_path)
    monkeypatch.setattr("pyrofit.data.fetch.missing", lambda folder: ["PMMA/run.csv", "b"])
    assert cli.main(["data", "where"]) == 2
    said = capsys.readouterr().err
    assert (
        "2 measured files are missing, the first is PMMA/run.csv; get them with `make data`" in said
    )


def test_failed_download_ends_with_code_2(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse() -> None:
        raise DataError("no connection; try again")

    monkeypatch.setattr("pyrofit.data.fetch.fetch", refuse)
    assert cli.main(["data", "fetch"]) == 2
    assert capsys.readouterr().err == "error: no connection; try again\n"


def test_a_reader_that_ends_early_is_no_error(tmp_path: Path) -> None:
    words = [sys.executable, "-u", "-m", "pyrofit", "init", "x"]
    with subprocess.Popen(
        words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as run:
        assert run.stdout is not None
        assert run.stderr is not None
        run.stdout.close()
        said = run.stderr.read()
    assert run.returncode == 0
    assert "Traceback" not in said
