"""Failures of a cluster's jobs are told by their cause."""

from pathlib import Path

import pytest

from pyrofit.running import causes

STEP = "slurmstepd-n1: error: *** JOB 7 ON n1 CANCELLED AT 2026-11-23T09:24:43"
SAID = {
    "slurmstepd-n1: error: StepId=7.batch exceeded memory limit (132 > 125), killed": "memory",
    "slurmstepd: error: Detected 1 oom_kill event in StepId=7.batch.": "memory",
    f"{STEP} DUE TO TIME LIMIT ***": "raise its runtime",
    f"{STEP} DUE TO NODE FAILURE, SEE SLURMCTLD LOG FOR DETAILS ***": "lost its node",
    f"{STEP} ***": "was cancelled",
}


@pytest.mark.parametrize("line", SAID)
def test_cause_is_told_with_job_and_rule(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    folder = causes.LOGS / "rule_imp_RMSE_00"
    folder.mkdir(parents=True)
    (folder / "6.log").write_text(f"of an earlier run\n{STEP} ***\n")
    before = causes.logs()
    (folder / "7.log").write_text(f"Building DAG of jobs...\n{line}\n{STEP} ***\n")
    (folder / "8.log").write_text("error: window 5000 to 6000 s: 0 points lie inside\n")
    (told,) = causes.causes(before)
    assert told.startswith("imp_RMSE_00 (Slurm job 7) ")
    assert SAID[line] in told


def test_run_without_slurm_tells_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert list(causes.causes(causes.logs())) == []
