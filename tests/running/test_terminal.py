"""What a run prints, from the events that Snakemake logs."""

import logging
from enum import Enum
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from pyrofit.errors import BY_RUN, INTERRUPTED
from pyrofit.running.terminal import FOR_USER, Terminal, show_work, take_over
from pyrofit.running.work import WorkDone


class Event(Enum):
    RUN_INFO = "run_info"
    JOB_INFO = "job_info"
    JOB_FINISHED = "job_finished"
    JOB_ERROR = "job_error"
    SHELLCMD = "shellcmd"
    ERROR = "error"


class Quietness(Enum):
    REASON = 1
    RULES = 2


class Run:
    """A run whose events are logged as Snakemake logs them."""

    def __init__(self, dryrun: bool = False) -> None:
        self.lines: list[str] = []
        self.now = 0.0
        self.display = Terminal(SimpleNamespace(dryrun=dryrun), None)
        self.display.say = self.lines.append
        self.display.clock = lambda: self.now

    def log(self, event: Event | None, text: str = "", **about: Any) -> None:
        level = logging.ERROR if event in (Event.JOB_ERROR, Event.ERROR) else logging.INFO
        record = logging.LogRecord("s", about.pop("level", level), "", 0, text, None, None)
        vars(record).update({"event": event} if event else {}, **about)
        self.display.emit(record)

    def start(self, number: int, title: str | None, rule: str = "step") -> None:
        self.log(Event.JOB_INFO, jobid=number, rule_msg=title, rule_name=rule, reason="why")
        self.log(Event.SHELLCMD, "python -m pyrofit")

    def fail(self, number: int, *logs: Path) -> None:
        self.log(Event.ERROR, 'RuleException:\nCalledProcessError in file "a.smk", line 3:\n...')
        self.log(Event.JOB_ERROR, jobid=number, log=list(map(str, logs)))

    def end(self) -> None:
        self.log(None, "Exiting because a job execution failed. Look below.", level=logging.ERROR)
        self.log(Event.ERROR, "WorkflowError:\nAt least one job did not complete successfully.")


@pytest.fixture(autouse=True)
def _environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(BY_RUN, "")  # so that it is restored at the end


def test_steps_are_told_at_start_and_end_with_their_time_and_the_work_left() -> None:
    run = Run()
    assert show_work([run.display], WorkDone({}, 1, run.lines.append, lambda: run.now))
    run.log(None, "Building DAG of jobs...")
    run.log(Event.RUN_INFO, "Job stats: ...", stats={"step": 2, "all": 1, "total": 3})
    run.start(4, "Kinetics")
    run.now = 30.0
    run.log(Event.JOB_FINISHED, job_id=4)
    run.start(5, "Report")
    run.now = 34.0
    run.log(Event.JOB_FINISHED, job_id=5)
    run.start(0, None, "all")
    run.log(Event.JOB_FINISHED, job_id=0)
    run.log(None, "Elapsed time: 0:00:34")
    assert run.lines == [
        "2 steps",
        "1/2  Kinetics",
        "1/2  done in 30 s; 50 %",
        "2/2  Report",
        "2/2  done in 4 s",
    ]


def test_stopped_run_ends_with_the_reason_the_log_and_the_way_out(tmp_path: Path) -> None:
    log = tmp_path / "kinetics.log"
    log.write_text("generation 1\nerror: data/run.csv: row 7 has no number;\n  correct it\n")
    run = Run()
    run.log(Event.RUN_INFO, stats={"step": 1})
    run.start(1, "Kinetics")
    run.fail(1, log)
    run.end()
    assert run.lines[2:] == [
        "1/1  failed",
        f"\nKinetics: data/run.csv: row 7 has no number;\n  correct it\nLog: {log}",
        "Correct this and run the same command again: finished parts are kept.",
    ]


def test_fault_of_the_program_and_a_silent_end_are_told_as_such(tmp_path: Path) -> None:
    log = tmp_path / "a.log"
    log.write_text("Traceback (most recent call last):\n  ...\nKeyError: 'x'\n")
    run = Run()
    for number, logs in ((1, [log]), (2, [tmp_path / "none.log"])):
        run.start(number, f"Step {number}")
        run.fail(number, *logs)
    run.end()
    assert "Step 1: KeyError: 'x' (the log tells more; please report it)" in run.lines[-3]
    assert "Step 2: it ended without a message in its log; " in run.lines[-2]


def test_step_that_is_tried_again_and_ends_well_is_no_failure(tmp_path: Path) -> None:
    run = Run()
    run.start(1, "Kinetics")
    run.fail(1, tmp_path / "a.log")
    run.start(1, "Kinetics")
    run.log(Event.JOB_FINISHED, job_id=1)
    run.log(Event.ERROR, "WorkflowError in file /x/study.smk, line 3:\nsomething else")
    assert run.lines[2].endswith("Kinetics, once more")
    assert run.lines[-1] == "error: something else"


def test_error_in_the_study_is_told_without_places_of_the_workflow() -> None:
    run = Run()
    run.log(
        Event.ERROR,
        'WorkflowError in file "/x/study.smk", line 82:\nmy.yaml: a rule:\n  unknown key\n'
        '  File "/x/study.smk", line 82, in <module>',
    )
    assert run.lines == ["error: my.yaml: a rule:\n  unknown key"]


def test_fault_of_snakemake_is_told_in_a_line() -> None:
    run = Run()
    run.log(Event.ERROR, "Traceback (most recent call last):\n\n  File ...\nOSError: no place\n")
    assert run.lines == ["error: OSError: no place (.snakemake/log has more; please report it)"]


def handler(name: str) -> logging.Handler:
    made = logging.NullHandler()
    made.name = name
    return made


@pytest.mark.parametrize("asked", [{}, {"verbose": True}, {"quiet": {Quietness.RULES}}])
def test_run_by_snakemake_alone_is_shown_likewise_unless_it_was_asked_otherwise(
    asked: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    usual = {"verbose": False, "debug_dag": False, "printshellcmds": False, "dryrun": False}
    settings = SimpleNamespace(**usual | {"quiet": {Quietness.REASON}} | asked)
    logger, work = logging.Logger("s"), WorkDone({}, 1)
    work.note("run_info", {"stats": {"step": 3, "all": 1, "total": 4}})
    for one in (handler("DefaultStreamHandler"), handler("DefaultLogFileHandler"), work):
        logger.addHandler(one)
    take_over(logger, settings, work)
    names = [type(one).__name__ for one in logger.handlers]
    if asked:
        assert names == ["NullHandler", "NullHandler", "WorkDone"]
    else:
        assert names == ["NullHandler", "Terminal"]
        assert logger.handlers[0].name == "DefaultLogFileHandler"
        assert capsys.readouterr().err == "3 steps\n"


def test_only_what_is_for_the_user_is_told_besides() -> None:
    run = Run()
    run.log(None, "Select jobs to execute...")
    run.log(None, "Report: results/a/report.html", **FOR_USER)
    run.log(None, "a file has a date of tomorrow", level=logging.WARNING)
    run.log(None, "Terminating processes on user request, this might take some time.")
    run.log(None, "Nothing to be done (all requested files are present and up to date).")
    assert run.lines == [
        "Report: results/a/report.html",
        "a file has a date of tomorrow",
        INTERRUPTED,
        "Everything is made already: nothing to do.",
    ]


def test_dry_run_lists_the_steps() -> None:
    run = Run(dryrun=True)
    run.log(Event.RUN_INFO, stats={"step": 1})
    run.start(1, "Kinetics")
    assert run.lines == ["Kinetics"]
