"""How repetitions are shared out to jobs."""

from pathlib import Path
from typing import Any

import pytest

from pyrofit.config import Study, read_study
from pyrofit.errors import StudyError
from pyrofit.running.shares import LANES, MOST_JOBS, SIDE_BY_SIDE, jobs_of_repetitions, long_plan
from pyrofit.solver import run

CONFIG = Path(__file__).parents[2] / "config"


def study_of(repetitions: int, name: str = "smoke") -> Study:
    study = read_study(CONFIG / f"{name}.yaml")
    imp: dict[str, Any] = {"repetitions": repetitions}
    return study.model_copy(update={"imp": study.imp.model_copy(update=imp)})


@pytest.mark.parametrize("cores", [None, 1, 2, 64])
@pytest.mark.parametrize("wanted", [None, 1, "3", 8, 1000])
@pytest.mark.parametrize("repetitions", [1, 8, 25, 107, 1000])
def test_each_repetition_belongs_to_one_job(
    repetitions: int, wanted: object, cores: int | None
) -> None:
    found = jobs_of_repetitions(study_of(repetitions), wanted, cores)
    assert [n for job in found for n in job] == list(range(repetitions))


@pytest.mark.parametrize(
    ("repetitions", "jobs"),
    [(2, [1, 1]), (7, [7]), (9, [8, 1]), (16, [8, 8]), (18, [16, 1, 1]), (25, [16, 9])],
)
def test_on_a_cluster_sixteen_share_a_job_and_few_run_alone(
    repetitions: int, jobs: list[int]
) -> None:
    assert [len(job) for job in jobs_of_repetitions(study_of(repetitions))] == jobs


@pytest.mark.parametrize(
    ("repetitions", "cores", "jobs"),
    [
        (25, 1, [25]),
        (25, 2, [25]),
        (25, 5, [25]),
        (25, 6, [16, 9]),
        (25, 12, [8, 8, 8, 1]),
        (25, 64, [8, 8, 8, 1]),
        (9, 2, [9]),
        (9, 6, [8, 1]),
        (2, 2, [1, 1]),
        (40, 2, [32, 8]),
        (66, 2, [32, 32, 1, 1]),
    ],
)
def test_here_three_costs_have_a_job_for_each_core_and_few_run_alone(
    repetitions: int, cores: int, jobs: list[int]
) -> None:
    assert len(study_of(repetitions).imp.costs) == 3
    assert [len(job) for job in jobs_of_repetitions(study_of(repetitions), cores=cores)] == jobs


def test_full_jobs_fill_the_lanes_of_the_solver() -> None:
    assert LANES == run.LANES
    assert SIDE_BY_SIDE % LANES == 0


@pytest.mark.parametrize("cores", [None, 1, 2, 64])
def test_no_job_of_a_study_of_a_usual_size_runs_one_part_after_another(cores: int | None) -> None:
    found = jobs_of_repetitions(study_of(100), cores=cores)
    assert max(map(len, found)) <= SIDE_BY_SIDE


def test_more_repetitions_run_no_full_job_again() -> None:
    assert jobs_of_repetitions(study_of(50))[0] == jobs_of_repetitions(study_of(25))[0]


@pytest.mark.parametrize("cores", [None, 2, 64])
def test_thousands_of_repetitions_make_few_jobs_of_whole_eights(cores: int | None) -> None:
    study = study_of(1000)
    found = jobs_of_repetitions(study, cores=cores)
    assert len(found) * len(study.imp.costs) <= max(MOST_JOBS, cores or 0)
    assert {len(job) % 8 for job in found[:-1]} == {0}


def test_number_of_repetitions_in_a_job_may_be_set() -> None:
    assert [len(job) for job in jobs_of_repetitions(study_of(25), 10)] == [10, 10, 5]
    assert [len(job) for job in jobs_of_repetitions(study_of(25), "100")] == [25]


def test_repetitions_with_an_external_program_are_jobs_of_their_own() -> None:
    assert {len(job) for job in jobs_of_repetitions(study_of(200, "hotplate"))} == {1}
    assert [len(job) for job in jobs_of_repetitions(study_of(9, "hotplate"), 4)] == [4, 4, 1]


@pytest.mark.parametrize("wrong", [0, -1, 2.5, "many", True])
def test_no_number_of_repetitions_is_refused(wrong: object) -> None:
    with pytest.raises(StudyError, match=rf"--config repetitions_per_job={wrong}: not a whole"):
        jobs_of_repetitions(study_of(25), wrong)


def test_a_long_plan_is_announced() -> None:
    assert long_plan(study_of(25)) == ""
    assert "300,000 repetitions" in long_plan(study_of(100_000))
