"""The workflow as users run it: what runs, what is kept, what runs again."""

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest
from tiny import COSTS, FIT, OWN_FILE, SCORES, TINY, Project, Run

from pyrofit.config import as_study
from pyrofit.running.terminal import SAME_COMMAND

PREPARE = "Measured series into tidy tables, mass closure checked"
PREVIEW = "Data against limits, before any fit"
KINETICS = "Kinetics fitted to heated samples"
COLLECT = "All repetitions gathered"
IDENTIFY = "What the data determine of the inverse modelling"
IDENTIFY_KINETICS = "What the data determine of the kinetics"
ENERGIES = "Activation energy over conversion"
PREDICT = "Estimates and best sets simulated at slab_60 slab_80"
SQUARES = {f"Multistart least squares, {cost}" for cost in COSTS}
CMA_ES = {f"CMA-ES, {cost}" for cost in COSTS}
COMPARE = "All sets of all optimisers under all costs"
DESCENTS = {f"Least squares from SCE-UA's best set, {cost}" for cost in COSTS}
SUMMARY = "results/tiny/imp/summary.csv"


def sceua(*repetitions: int, costs: tuple[str, ...] = COSTS) -> set[str]:
    return {f"Inverse modelling, {cost}, repetition {n:02d}" for cost in costs for n in repetitions}


SEARCHES = sceua(0, 1)
GATHERED = {COLLECT, PREDICT, IDENTIFY, COMPARE} | DESCENTS
OF_KINETICS = {KINETICS, IDENTIFY_KINETICS, ENERGIES}
EVERYTHING = {PREPARE, PREVIEW} | OF_KINETICS | GATHERED | SEARCHES | SQUARES | CMA_ES


def computing(jobs: set[str]) -> set[str]:
    return {job for job in jobs if not job.startswith(("Tables and figures, ", "Report: "))}


def showing(run: Run) -> set[str]:
    return run.jobs - computing(run.jobs)


# --- a run ----------------------------------------------------------------------------------


def test_run_takes_every_step_once(finished: tuple[Project, Run]) -> None:
    _, run = finished
    assert computing(run.jobs) == EVERYTHING
    assert "Report: results/tiny/report.html" in run.jobs
    assert run.said.count("  done in ") == len(run.jobs)
    assert "Reason:" not in run.said
    assert run.said.endswith("Report: results/tiny/report.html\n")


def test_figures_of_the_kinetics_do_not_wait_for_the_searches(project: Project) -> None:
    figures = (project.root / "results" / "tiny" / "figures").glob("kinetics_*.svg")
    names = [f"results/tiny/figures/{path.name}" for path in figures]
    assert names
    planned = project.plan("--forceall", *names)
    assert planned == {PREPARE, KINETICS, IDENTIFY_KINETICS, "Tables and figures, kinetics"}


def test_run_leaves_report_provenance_logs_and_nothing_unfinished(project: Project) -> None:
    results = project.root / "results" / "tiny"
    page = (results / "report.html").read_text(encoding="utf-8")
    assert TINY["title"] in page
    assert json.loads((results / "provenance.json").read_text())
    assert {"prepare.log", "kinetics.log", "imp_RMSE_00.log"} <= {
        p.name for p in (results / "logs").iterdir()
    }
    assert [p.name for p in results.rglob(".*")] == []


def test_given_configfile_replaces_the_default_study(project: Project) -> None:
    kept = json.loads((project.root / "results" / "tiny" / "study.json").read_text())
    assert kept == as_study(TINY, "mine/tiny.yaml").model_dump(mode="json")
    assert kept["published"] is None
    assert not (project.root / "results" / "twin").exists()


def test_second_run_does_nothing(project: Project) -> None:
    run = project.snakemake("--cores", "2")
    assert run.code == 0
    assert "Nothing to be done" in run.said
    assert run.jobs == set()


# --- what a change runs again ---------------------------------------------------------------

ALL_IMP = SEARCHES | SQUARES | CMA_ES | GATHERED
RANGE = {"experiment": "slab_60", "signal": "mlr", "kind": "RANGE", "options": {"r": 0.1}}
CHANGES: dict[str, tuple[str, object, set[str]]] = {
    "title": ("title", "Another title", set()),
    "one more repetition": ("imp.repetitions", 3, sceua(2) | GATHERED),
    "option of one cost": (
        "imp.costs.RANGE",
        [RANGE],
        sceua(0, 1, costs=("RANGE",))
        | {"Multistart least squares, RANGE", "CMA-ES, RANGE"}
        | GATHERED,
    ),
    "seed": ("seed", 4, EVERYTHING),
    "budget of the kinetics, used by all": (
        "kinetics.sceua.generations",
        4,
        OF_KINETICS | ALL_IMP,
    ),
    "experiments to predict": (
        "validation.experiments",
        ["slab_80", "slab_60"],
        {"Estimates and best sets simulated at slab_80 slab_60", COMPARE},
    ),
}


@pytest.mark.parametrize(("place", "value", "jobs"), CHANGES.values(), ids=CHANGES)
def test_change_runs_its_dependents_again_and_no_other(
    place: str, value: object, jobs: set[str], project: Project, finished: tuple[Project, Run]
) -> None:
    project.change(place, value)
    assert project.plan() == jobs | showing(finished[1])


def test_edit_that_is_taken_back_computes_nothing_again_beside_one_that_stays(
    project: Project,
) -> None:
    inputs = "results/tiny/inputs/kinetics.json"
    before = project.read(inputs)
    project.change("seed", 4)
    assert computing(project.plan()) == EVERYTHING
    assert project.read(inputs) != before
    project.change("title", "Another title")
    assert computing(project.plan()) == set()
    assert project.read(inputs) == before


def test_change_on_the_command_line_counts_like_one_in_the_file(project: Project) -> None:
    jobs = project.plan("--config", 'imp={"repetitions": 3}')
    assert computing(jobs) == sceua(2) | GATHERED


def test_repetitions_of_a_cost_share_a_job_unless_cores_would_stay_idle(project: Project) -> None:
    nine = ("--config", 'imp={"repetitions": 9}')
    together = {f"Inverse modelling, {cost}, repetition 00 to 08" for cost in COSTS}
    assert computing(project.plan(*nine, "--cores", "1")) == together | GATHERED
    eights = {f"Inverse modelling, {cost}, repetition 00 to 07" for cost in COSTS}
    jobs = project.plan(*nine, "--cores", str(2 * len(COSTS)))
    assert computing(jobs) == eights | sceua(8) | GATHERED


def test_another_number_of_cores_runs_nothing_again(project: Project) -> None:
    assert project.plan("--cores", "1") == set()
    assert project.plan("--cores", "64") == set()


def test_repetitions_of_a_job_are_a_setting_of_the_run_that_runs_nothing_again(
    project: Project,
) -> None:
    assert project.plan("--config", "repetitions_per_job=2") == set()
    jobs = project.plan("--config", 'imp={"repetitions": 7}', "repetitions_per_job=3")
    shared = {
        f"Inverse modelling, {cost}, repetition {numbers}"
        for cost in COSTS
        for numbers in ("00 to 02", "03 to 05", "06")
    }
    assert computing(jobs) == shared | GATHERED
    wrong = project.snakemake("--dry-run", "--config", "repetitions_per_job=some")
    assert wrong.code != 0
    assert "--config repetitions_per_job=some: not a whole number" in wrong.said


def test_changed_file_of_measurements_runs_its_readers_again(project: Project) -> None:
    file = project.root / "mine" / "data" / "run.csv"
    file.write_text(OWN_FILE.replace("5.0", "5.1"))
    try:
        assert computing(project.plan()) == EVERYTHING
    finally:
        file.write_text(OWN_FILE)


def test_edited_source_runs_again_what_it_computes(project: Project) -> None:
    source = project.root / "src" / "pyrofit" / "cost" / "kinds.py"
    before = source.read_text()
    source.write_text(before + "EDITED = True\n")
    try:
        assert computing(project.plan()) == EVERYTHING
    finally:
        source.write_text(before)


def test_edited_figure_computes_nothing_again(project: Project) -> None:
    source = project.root / "src" / "pyrofit" / "show" / "subjects" / "validation" / "fig3.py"
    before = source.read_text()
    source.write_text(before + "EDITED = True\n")
    try:
        planned = project.plan()
    finally:
        source.write_text(before)
    # The files of one subject are made anew together.
    assert planned == {"Tables and figures, validation", "Report: results/tiny/report.html"}


def test_edited_diagnosis_runs_no_step_of_the_fits_again(project: Project) -> None:
    source = project.root / "src" / "pyrofit" / "diagnose" / "diagnosis.py"
    before = source.read_text()
    source.write_text(before + "EDITED = True\n")
    try:
        assert computing(project.plan()) == set()
    finally:
        source.write_text(before)


def test_edited_comments_and_docstrings_run_nothing_again(project: Project) -> None:
    source = project.root / "src" / "pyrofit" / "data" / "cone_exports.py"
    before = source.read_text()
    edited = before.replace('"""', '"""Edited. ', 1) + "# edited\n"
    assert edited.count("dited") == before.count("dited") + 2
    source.write_text(edited)
    try:
        assert project.plan() == set()
    finally:
        source.write_text(before)


def test_new_effect_in_the_package_runs_nothing_again(project: Project) -> None:
    effects = project.root / "src" / "pyrofit" / "effects"
    new = effects / "k_T_again.py"
    new.write_text((effects / "k_T.py").read_text())
    try:
        assert project.plan() == set()
    finally:
        new.unlink()


@pytest.fixture(scope="module")
def on_known_kinetics(
    finished: tuple[Project, Run], tmp_path_factory: pytest.TempPathFactory
) -> tuple[Project, dict[str, Any]]:
    """Return a run whose inverse modelling takes published kinetics, not the fitted ones."""
    project = Project.copy(finished[0].root, tmp_path_factory.mktemp("known") / "project")
    study: dict[str, Any] = json.loads(json.dumps(TINY))
    study["imp"] |= {"kinetics": "known", "repetitions": 1}
    study["imp"]["costs"].pop("RANGE")
    project.write(study)
    run = project.snakemake("--cores", "2", SCORES, FIT)
    assert run.code == 0, run.said
    return project, study


@pytest.mark.parametrize(
    ("stage", "key", "value"),
    [("kinetics", "sceua", {"complexes": 2, "generations": 4}), ("parameters", "T_p", None)],
    ids=["budget of the kinetics", "limits of a TGA parameter"],
)
def test_change_of_the_tga_fit_alone_runs_nothing_else_again(
    stage: str, key: str, value: object, on_known_kinetics: tuple[Project, dict[str, Any]]
) -> None:
    project, study = on_known_kinetics
    changed = json.loads(json.dumps(study))
    changed[stage][key] = value or {**study[stage][key], "upper": 650}
    project.write(changed)
    assert project.plan(SCORES, FIT) == {KINETICS}


# --- mistakes -------------------------------------------------------------------------------


def fingerprints(folder: Path) -> dict[str, str]:
    return {
        p.relative_to(folder).as_posix(): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in folder.rglob("*")
        if p.is_file()
    }


def test_broken_study_is_told_and_results_stay(project: Project) -> None:
    results = project.root / "results" / "tiny"
    before = fingerprints(results)
    project.change("parameters.rho.lower", 1600)
    run = project.snakemake("--cores", "2")
    assert run.code != 0
    assert "tiny.yaml: the study description breaks a rule:" in run.said
    assert "parameters.rho: lower (1600) must be below upper (1500)" in run.said
    assert "Traceback" not in run.said
    assert fingerprints(results) == before


def test_step_that_fails_shows_its_message_and_keeps_what_is_finished(
    project: Project, finished: tuple[Project, Run]
) -> None:
    fit = project.read(FIT)
    project.change("imp.costs.RANGE", [{**RANGE, "window_s": [5000, 6000]}])
    run = project.snakemake("--cores", "2", "--keep-going", SUMMARY)
    assert run.code != 0
    assert ": window 5000 to 6000 s: 0 points lie inside" in run.said
    assert run.said.endswith(f"{SAME_COMMAND}\n")
    assert "Traceback" not in run.said
    assert project.read(FIT) == fit
    assert (project.root / "results/tiny/imp/RMSE/00.json").exists()
