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


SEARCHES = {"imp_A": 12_000.0, "optimise": 8_000.0, "descent": 700.0}
SHORT = {"collect": 5.0, "descent": 6.0, "predict": 6.0, "report": 8.0}
SHORT |= {f"show_{n}": 7.0 for n in range(8)}
RECORDED = {
    "one rate": {"prepare": 6.0, "preview": 56.0, "kinetics": 16.0, "identify_kinetics": 94.0}
    | {"imp_A": 16.5, "optimise": 8.4, "identify": 44.0, "compare": 6.0},
    "three rates": {"prepare": 8.0, "preview": 80.0, "isoconversional": 78.0, "kinetics": 89.0}
    | {
        "identify_kinetics": 41.0,
        "imp_A": 52.0,
        "optimise": 67.0,
        "identify": 67.0,
        "compare": 8.0,
    },
    "slow searches": {"prepare": 6.0, "preview": 53.0, "isoconversional": 67.0, "kinetics": 110.0}
    | {
        "identify_kinetics": 26.0,
        "imp_A": 90.0,
        "optimise": 33.0,
        "identify": 57.0,
        "compare": 22.0,
    },
}
"""Seconds of the steps of recorded runs, beside other work; short steps are alike."""


@pytest.mark.parametrize("took", RECORDED.values(), ids=RECORDED)
def test_share_rises_steadily_and_near_the_true_one(took: dict[str, float]) -> None:
    steps = {**took, **SHORT}
    run = Run(SEARCHES, cores=1)
    run.log(Event.RUN_INFO, stats=dict.fromkeys(steps, 1))
    shares = []
    for number, (rule, seconds) in enumerate(steps.items(), start=1):
        run.step(number, rule, seconds, total=len(steps))
        if number < len(steps):
            shares.append(float(run.lines[-1].split("] ")[1].split(" %")[0]) / 100.0)
    true = [sum([*steps.values()][:n]) / sum(steps.values()) for n in range(1, len(steps))]
    assert shares == sorted(shares)
    assert max(abs(a - b) for a, b in zip(shares, true, strict=True)) < 0.17


def test_time_left_counts_steps_that_others_wait_for_alone() -> None:
    run = Run({"imp_A": 1_000.0}, cores=2)
    run.log(Event.RUN_INFO, stats={"imp_A": 3, "identify": 1, "show_fit": 2})
    run.step(1, "imp_A", 42.0, 6)
    # Two of 42 s and two of 2 s side by side, and 20 s alone.
    assert run.lines[-1].endswith("about 64 s left")


def test_step_that_lasts_longer_than_expected_keeps_the_share_below_one() -> None:
    run = Run({}, cores=1)
    run.log(Event.RUN_INFO, stats={"identify": 1, "report": 1})
    run.log(Event.JOB_INFO, jobid=1, rule_name="identify")
    run.now += 500.0
    run.log(Event.PROGRESS, done=0, total=2)
    assert "] 99 %" in run.lines[-1]


@pytest.mark.parametrize("name", ["paper", "twin", "hotplate"])
def test_jobs_have_the_calls_of_their_searches(name: str) -> None:
    study = read_study(CONFIG / f"{name}.yaml")
    cost = next(iter(study.imp.costs))
    found = calls_of_jobs(study, [["00", "01"], ["02"]])
    assert found[f"imp_{cost}_00"] == 2 * found[f"imp_{cost}_02"] == 2 * sceua_calls(study.imp)
