"""The bar of a run counts steps by their time."""

import logging
from enum import Enum
from pathlib import Path
from typing import Any

import pytest

from pyrofit.config import read_study
from pyrofit.estimate.calls import calls_of_jobs, sceua_calls
from pyrofit.running.work import WorkDone

CONFIG = Path(__file__).parents[2] / "config"


class Event(Enum):
    RUN_INFO = "run_info"
    JOB_INFO = "job_info"
    JOB_FINISHED = "job_finished"
    PROGRESS = "progress"


class Run:
    """A run whose events are logged as Snakemake logs them."""

    def __init__(self, calls: dict[str, float], cores: int | None) -> None:
        self.lines: list[str] = []
        self.now = 0.0
        self._handler = WorkDone(calls, cores, self.lines.append, lambda: self.now)

    def log(self, event: Event, **about: Any) -> None:
        record = logging.LogRecord("snakemake", logging.INFO, "", 0, None, None, None)
        vars(record).update(event=event, **about)
        self._handler.emit(record)

    def step(self, number: int, rule: str, seconds: float, total: int) -> None:
        self.log(Event.JOB_INFO, jobid=number, rule_name=rule)
        self.now += seconds
        self.log(Event.JOB_FINISHED, job_id=number)
        self.log(Event.PROGRESS, done=number, total=total)


def test_a_long_search_counts_more_than_short_steps() -> None:
    run = Run({"imp_A": 10_000.0, "imp_B": 30_000.0}, cores=1)
    run.log(Event.RUN_INFO, stats={"prepare": 1, "imp_A": 1, "imp_B": 1, "report": 1, "total": 4})
    run.step(1, "prepare", 2.0, 4)
    assert "left" not in run.lines[-1]  # no search has told the time of a call
    run.step(2, "imp_A", 102.0, 4)
    # 10 ms a call: 302 s for the other search and 2 s for the report, after 104 s.
    assert run.lines[-1] == f"work: [{'#' * 5}{'.' * 15}] 25 %, about 5 min left"
    run.log(Event.JOB_INFO, jobid=3, rule_name="imp_B")
    run.now += 200.0
    run.log(Event.PROGRESS, done=2, total=4)
    assert run.lines[-1].endswith("75 %, about 104 s left")  # 304 s of 408
    run.log(Event.PROGRESS, done=9, total=9)
    assert len(run.lines) == 3  # nothing is left to say at the end


def test_no_time_is_given_where_cores_are_unknown() -> None:
    run = Run({"imp_A": 100.0}, cores=None)
    run.log(Event.RUN_INFO, stats={"imp_A": 2})
    run.step(1, "imp_A", 10.0, 2)
    assert run.lines == [f"work: [{'#' * 10}{'.' * 10}] 50 %"]


@pytest.mark.parametrize("name", ["paper", "twin", "hotplate"])
def test_jobs_have_the_calls_of_their_searches(name: str) -> None:
    study = read_study(CONFIG / f"{name}.yaml")
    cost = next(iter(study.imp.costs))
    found = calls_of_jobs(study, [["00", "01"], ["02"]])
    assert found[f"imp_{cost}_00"] == 2 * found[f"imp_{cost}_02"] == 2 * sceua_calls(study.imp)
