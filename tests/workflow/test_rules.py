"""The rules themselves: what Snakemake says of them, its own report, the profile of a cluster."""

import os
import re
import resource
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml
from tiny import ROOT, Project

SLURM = ROOT / "profiles" / "slurm" / "config.yaml"
CLUSTER = ROOT / "docs" / "cluster.md"
BLIND_TEST = "workflow/blind_test.smk"
SMOKE = ("--configfile", "config/smoke.yaml")


def snakemake(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Call Snakemake without running anything."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        ["snakemake", "--nocolor", *arguments],
        cwd=ROOT,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("snakefile", ["Snakefile", BLIND_TEST])
def test_snakemake_finds_nothing_in_the_rules_but_that_they_name_no_container(
    snakefile: str,
) -> None:
    # The software is fixed by requirements.lock.
    said = snakemake("--lint", "--snakefile", snakefile).stderr
    titles = set(re.findall(r"^    \* (.*?):?$", said, re.M))
    assert titles == {"Specify a conda environment or container for each rule."}, said


def test_broken_blind_test_stops_no_study(tmp_path: Path) -> None:
    project = Project.copy(ROOT, tmp_path / "project")
    setting = project.root / "config" / "blind_test.yaml"
    whole = project.plan()
    assert whole
    for broken, says in (("plans: {full: 3}", "plans.full"), ("plans: [", "not valid")):
        setting.write_text(broken)
        assert project.plan() == whole
        run = project.snakemake("--dry-run", "--snakefile", BLIND_TEST)
        assert run.code != 0
        assert "config/blind_test.yaml" in run.said
        assert says in run.said
    setting.unlink()
    assert project.plan() == whole


@pytest.mark.parametrize(
    ("target", "test", "plan", "jobs"),
    [
        ((), "blind_test", "full", 40),
        (("short",), "blind_test", "short", 2),
        (("foreign",), "foreign_truth", "full", 20),
        (("foreign_part",), "foreign_truth", "part", 2),
        (("gpyro",), "gpyro_truth", "full", 8),
    ],
)
def test_blind_test_runs_its_full_plan_unless_told_otherwise(
    target: tuple[str, ...], test: str, plan: str, jobs: int
) -> None:
    ran = snakemake("--dry-run", "--forceall", "--snakefile", BLIND_TEST, *target)
    said = ran.stdout + ran.stderr
    assert ran.returncode == 0, said
    planned = re.findall(r"Blind test of the diagnosis, (\w+), plan (\w+), job (\d+)", said)
    assert set(planned) == {(test, plan, str(job)) for job in range(jobs)}
    assert f"{test}, plan {plan}: tables, figures, page" in said


def test_report_of_snakemake_shows_every_figure_and_table(project: Project) -> None:
    run = project.snakemake("--report", "results/tiny/snakemake.html")
    assert run.code == 0, run.said
    assert "Report created." in run.said
    assert "arning" not in run.said
    results = project.root / "results" / "tiny"
    shown = [*results.glob("figures/*.svg"), *results.glob("tables/*.csv"), results / "report.html"]
    assert len(shown) > 15
    for path in shown:
        assert f"Adding {path.name} " in run.said
    page = (results / "snakemake.html").read_text(encoding="utf-8")
    for words in ("Convergence of SCE-UA", "Best set, mean and standard", "by inverse model"):
        assert words in page
    (results / "snakemake.html").unlink()


def test_plugin_of_slurm_is_the_version_that_the_profile_was_tried_with() -> None:
    extra = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    (plugin,) = extra["project"]["optional-dependencies"]["slurm"]
    locked = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    assert re.fullmatch(r"snakemake-executor-plugin-slurm==[\d.]+", plugin)
    assert f"\n{plugin} " in locked
    assert f"plugin {plugin.partition('==')[2]}" in CLUSTER.read_text(encoding="utf-8")


def test_profile_of_slurm_holds_for_the_rules() -> None:
    # All but the executor and its settings, which are those of a plugin.
    profile = ("--workflow-profile", "profiles/slurm", "--executor", "local")
    ran = snakemake("--dry-run", "--forceall", *profile, *SMOKE)
    assert ran.returncode == 0, ran.stderr
    assert "slurm_partition=" in ran.stdout + ran.stderr
    given = yaml.safe_load(SLURM.read_text(encoding="utf-8"))
    rules = set(snakemake("--list-rules", *SMOKE).stdout.split())
    assert set(given["groups"]) | set(given["set-resources"]) <= rules
    assert set(given["groups"].values()) == set(given["group-components"])
    known = snakemake("--help").stdout
    for key in given:
        assert f"--{key}" in known or key.startswith("slurm-"), key


def test_groups_of_the_profile_ask_for_little() -> None:
    given = yaml.safe_load(SLURM.read_text(encoding="utf-8"))
    # Of each group, not of all: members run one after the other, on one core.
    assert given["resources"] == {"in_turn": 1}
    assert given["set-resource-scopes"] == {"in_turn": "local"}
    for rule, group in given["groups"].items():
        asks = given["set-resources"][rule]
        assert asks["in_turn"] == 1
        assert asks["runtime"] * given["group-components"][group] <= 60
    # Of any job, in the last attempt as well.
    megabytes, times, attempt = given["default-resources"]["mem_mb"].split()
    assert (times, attempt) == ("*", "attempt")
    assert int(megabytes) * (given["retries"] + 1) <= 4000


def test_profile_of_slurm_keeps_what_the_default_profile_says() -> None:
    usual = yaml.safe_load((ROOT / "profiles" / "default" / "config.yaml").read_text())
    given = yaml.safe_load(SLURM.read_text(encoding="utf-8"))
    usual = {key: value for key, value in usual.items() if not key.startswith("__")}
    del usual["cores"]  # those of this machine; on a cluster it is `jobs`
    assert {key: given[key] for key in usual} == usual


def test_thousand_repetitions_are_planned_soon_in_at_most_a_hundred_jobs() -> None:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ran = snakemake("--dry-run", "--config", 'imp={"repetitions": 1000}', *SMOKE)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert ran.returncode == 0, ran.stderr
    total = re.search(r"^total +(\d+)$", ran.stdout + ran.stderr, re.M)
    assert total is not None
    assert int(total[1]) <= 100
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    assert spent < 15.0  # 6 to 9 s were measured


@pytest.mark.measured
def test_shipped_study_of_pine_plans_its_report() -> None:
    ran = snakemake("--dry-run", "--configfile", "config/pine.yaml")
    said = ran.stdout + ran.stderr
    assert ran.returncode == 0, said
    planned = set(re.findall(r"^Job \d+: (.*)$", said, re.M))
    assert "Kinetics fitted to heated samples" in planned
    assert "Report: results/pine/report.html" in planned
    assert "Inverse modelling, RMSE, repetition 00" in planned
