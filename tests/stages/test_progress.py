"""Lines on long searches."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from pyrofit.diagnose.search.progress import ROUGHLY, SECOND, TO_THE_END, SearchProgress, Whole
from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import Status
from pyrofit.stages.progress import CallsTold, Told, counted


def test_searches_side_by_side_share_a_line_with_the_time_left(
    capsys: pytest.CaptureFixture[str],
) -> None:
    now = [0.0]
    told = Told("RMSE 00 to 01", 2, 10, lambda: now[0])
    for generation in range(2, 11):
        now[0] += 1.5
        for search in told.of_each:
            search(generation, 100 * generation, 1.0 / generation)
    lines = capsys.readouterr().err.splitlines()
    # Every 3 s, two generations: the next line is due 2 s after the last one.
    assert [line.split()[5] for line in lines] == ["2", "4", "6", "8", "10"]
    assert lines[0].endswith("generation 2 of 10, 200 model calls, lowest cost 0.5")
    assert lines[1].endswith(
        "generation 4 of 10, 700 model calls, lowest cost 0.25, about 10 s left"
    )
    assert lines[-1].endswith("generation 10 of 10, 1,900 model calls, lowest cost 0.1")


def test_fits_of_a_diagnosis_are_counted_with_the_time_left_of_these_and_of_all() -> None:
    now, lines = [0.0], list[str]()
    whole = Whole(lambda: now[0])
    now[0] = 20.0  # the fit of the base model
    told = SearchProgress(ROUGHLY, whole, 30, lines.append, lambda: now[0])
    for done, at in ((1, 22.0), (6, 32.0), (8, 36.0), (29, 78.0), (30, 110.0)):
        now[0] = at
        told(done)
    assert lines == [
        # 25 % of all with the base, and 6/30 of the next 20 %: 29 % in 32 s.
        "one effect more, roughly: 6 of 30 fits, about 48 s left; the diagnosis: about 78 s left",
        "one effect more, roughly: 29 of 30 fits, about 2 s left; the diagnosis: about 98 s left",
    ]


def test_time_left_of_a_diagnosis_falls_and_is_at_least_that_of_the_part() -> None:
    now, shares = [100.0], []
    whole = Whole(lambda: now[0] - 100.0)
    now[0] = 200.0
    for part in (ROUGHLY, SECOND, TO_THE_END) * 2:
        whole.begin(part)
        shares += [whole.left(part, share) for share in (0.0, 0.5, 1.0)]
    assert shares == sorted(shares, reverse=True)
    lines: list[str] = []
    told = SearchProgress(TO_THE_END, whole, 10, lines.append, lambda: now[0])
    now[0] = 800.0
    told(1)
    assert lines[0].endswith("about 90 min left; the diagnosis: about 90 min left")


def test_counted_calls_are_told_with_the_time_left(capsys: pytest.CaptureFixture[str]) -> None:
    now = [0.0]
    told = CallsTold("CMA-ES, RMSE", 3000, lambda: now[0])
    for now[0] in (10.0, 20.0, 30.0, 60.0, 90.0):
        told.add(1000)
    assert capsys.readouterr().err.splitlines() == [
        "CMA-ES, RMSE: 2,000 of about 3,000 model calls, about 10 s left",
        "CMA-ES, RMSE: 4,000 model calls",
        "CMA-ES, RMSE: 5,000 model calls",
    ]


def test_counted_problem_counts_the_calls_of_a_copy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Problem, "outcomes", lambda _, values, sets, led: [(Status.OK, [])] * sets)
    empty: Any = None
    one = np.ones(2)
    problem = Problem(("k", "cp"), 0.0 * one, one, empty, {}, {}, (), empty, empty)
    told = CallsTold("CMA-ES, RMSE", 10)
    replace(counted(problem, told), upper=2.0 * one).simulate_all(np.ones((3, 2)))
    counted(problem, told).simulate(one)
    assert told.calls == 4
