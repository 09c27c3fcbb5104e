"""How repetitions are shared out to jobs."""

from pathlib import Path
from typing import Any

import pytest

from pyrofit.config import Study, read_study
from pyrofit.errors import StudyError
from pyrofit.running.shares import MOST_JOBS, shares

CONFIG = Path(__file__).parents[2] / "config"


def study_of(repetitions: int, name: str = "smoke") -> Study:
    study = read_study(CONFIG / f"{name}.yaml")
    imp: dict[str, Any] = {"repetitions": repetitions}
    return study.model_copy(update={"imp": study.imp.model_copy(update=imp)})


@pytest.mark.parametrize("wanted", [None, 1, "3", 8, 1000])
@pytest.mark.parametrize("repetitions", [1, 8, 25, 107, 1000])
def test_each_repetition_belongs_to_one_job(repetitions: int, wanted: object) -> None:
    found = shares(study_of(repetitions), wanted)
    assert [n for job in found for n in job] == list(range(repetitions))


@pytest.mark.parametrize(
    ("repetitions", "jobs"),
    [(2, [1, 1]), (7, [7]), (9, [8, 1]), (16, [8, 8]), (18, [16, 1, 1]), (25, [16, 9])],
)
def test_sixteen_share_a_job_and_few_run_alone(repetitions: int, jobs: list[int]) -> None:
    assert [len(job) for job in shares(study_of(repetitions))] == jobs


def test_more_repetitions_run_no_full_job_again() -> None:
    assert shares(study_of(50))[0] == shares(study_of(25))[0]


def test_thousands_of_repetitions_make_few_jobs_of_whole_sixteens() -> None:
    study = study_of(1000)
    found = shares(study)
    assert len(found) * len(study.imp.costs) <= MOST_JOBS
    assert {len(job) % 16 for job in found[:-1]} == {0}


def test_number_of_repetitions_in_a_job_may_be_set() -> None:
    assert [len(job) for job in shares(study_of(25), 10)] == [10, 10, 5]
    assert [len(job) for job in shares(study_of(25), "100")] == [25]


def test_repetitions_with_an_external_program_are_jobs_of_their_own() -> None:
    assert {len(job) for job in shares(study_of(200, "hotplate"))} == {1}
    assert [len(job) for job in shares(study_of(9, "hotplate"), 4)] == [4, 4, 1]


@pytest.mark.parametrize("wrong", [0, -1, 2.5, "many", True])
def test_no_number_of_repetitions_is_refused(wrong: object) -> None:
    with pytest.raises(StudyError, match=rf"--config repetitions_per_job={wrong}: not a whole"):
        shares(study_of(25), wrong)
