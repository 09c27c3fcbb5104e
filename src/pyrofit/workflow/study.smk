"""The whole study: data, kinetics, inverse modelling, validation, tables, figures, report."""

import os
import shutil
import sys
import time
from itertools import product
from pathlib import Path

from snakemake.logging import logger
from snakemake.utils import min_version

from pyrofit.running.interrupt import (
    end_while_starting,
    end_with_cluster,
    end_with_jobs,
)

# In another workflow, which uses this one as a module, hooks and signals are that one's.
OWN = workflow.modifier.is_main_snakefile()
if (
    OWN and workflow.is_main_process
):  # before slow imports: Ctrl-C says one line from here on
    end_while_starting()

from pyrofit.config import as_study
from pyrofit.config.expand.programs import externals, program_files
from pyrofit.config.check.unmeasured import unmeasured
from pyrofit.config.check.unusual import unusual_values
from pyrofit.discovery import added, loaded
from pyrofit.errors import PyrofitError
from pyrofit.provenance import STUDY as STUDY_MODULES
from pyrofit.results import dependencies
from pyrofit.results.files import Results
from pyrofit.results.kinetics import heats_shown
from pyrofit.running import causes, shares
from pyrofit.estimate.calls import calls_of_jobs
from pyrofit.running.given import DEFAULT, study_of_files, from_workflow
from pyrofit.running.lock import end_run, join_run, start_run
from pyrofit.running.plan import InputFiles, study_of_run
from pyrofit.running.terminal import FOR_USER, show_work, take_over
from pyrofit.running.work import WorkDone
from pyrofit.show.sections import FIGURES, SUBJECTS, TABLES
from pyrofit.stages.reading import check_measurements

min_version("9.27")


report: "report/workflow.rst"


# Jobs run by this interpreter, not by the pyrofit that PATH finds. As a variable of the shell it is
# no part of a rule: an environment that moves reruns nothing.
os.environ.update(PYROFIT_PYTHON=sys.executable)


# A given --configfile replaces the default study; Snakemake alone would merge the two.
if OWN and not workflow.configfiles and os.path.exists(DEFAULT):

    configfile: DEFAULT


try:
    changes = dict(workflow.config_settings.config) if OWN else dict(config)
    # How repetitions are shared out to jobs belongs to the run, not to the study.
    per_job = changes.pop(shares.KEY, None)
    given = (study_of_files if OWN else from_workflow)(workflow.configfiles, changes)
    if workflow.is_main_process:
        study = as_study(given.keys, given.source)
        check_measurements(study, given.source, macfp=False)
    else:  # a job of a cluster: the study file may have been edited since the start
        study = study_of_run(given.keys)
    ROOT = Path("results") / study.name
    plan = InputFiles(study, ROOT, as_they_are=not workflow.is_main_process)
    # A job of a cluster must share out as the process that submitted it.
    local = workflow.is_main_process and workflow.local_exec
    cores = workflow.resource_settings.cores if local else None
    SHARES = [
        [f"{n:02d}" for n in job]
        for job in shares.jobs_of_repetitions(study, per_job, cores)
    ]
    if not workflow.is_main_process:
        join_run(ROOT)
    elif OWN:
        if told := shares.long_plan(study):
            print(told, file=sys.stderr, flush=True)
        work = WorkDone(calls_of_jobs(study, SHARES), cores)
        if not show_work(workflow.logger_manager.get_log_handlers(), work):
            logger.addHandler(work)
    elif not workflow.output_settings.dryrun:
        plan.begin()
except PyrofitError as error:
    raise WorkflowError(str(error)) from None

results = Results(ROOT)
FITS = "pyrofit.stages.fit"
COSTS = list(study.imp.costs)
# Inputs of external programs, and the cores of their simultaneous runs.
PROGRAM_FILES = list(program_files(study))
PROGRAMS = [experiment.program for experiment in externals(study).values()]
RUN_CORES = max([program.cores for program in PROGRAMS], default=1)
RUNS_CORES = max([p.parallel * p.cores for p in PROGRAMS], default=1)
OLD_LOGS = causes.logs()
STARTED_AT = time.time()
REPETITIONS = [repetition for job in SHARES for repetition in job]


wildcard_constraints:
    cost="|".join(COSTS),


onstart:
    try:
        if told := start_run(ROOT):
            print(told, file=sys.stderr)
        for sentence in unusual_values(study):
            print(f"warning: {given.source}: {sentence}", file=sys.stderr)
        plan.begin()
        if workflow.local_exec:
            end_with_jobs(ROOT)
            take_over(logger, workflow.output_settings, work)
        else:  # Snakemake cancels the jobs of a cluster
            end_with_cluster()
    except PyrofitError as error:
        raise WorkflowError(str(error)) from None


onerror:
    for _cause in causes.causes(OLD_LOGS):
        print(_cause, file=sys.stderr)
    end_run(ROOT)


onsuccess:
    end_run(ROOT)
    from pyrofit.show.headline import ending

    for _line in ending(study, results, STARTED_AT):
        logger.info(_line, extra=FOR_USER)


include: "rules/common.smk"
include: "rules/data.smk"
include: "rules/kinetics.smk"
include: "rules/programs.smk"
include: "rules/imp.smk"
include: "rules/identify.smk"
include: "rules/isoconversional.smk"
include: "rules/validation.smk"
include: "rules/comparison.smk"
include: "rules/report.smk"
include: "rules/diagnosis.smk"
include: "rules/steps.smk"


for _point in added("rules").values():

    include: str(loaded(_point))


# Everything, not the report alone: what is deleted or was removed with a failed run is made again.
EVERYTHING = [
    [
        results.of_step(name, file)
        for name, step in known_steps().items()
        if step.early
        for file in inputs_of(name).files
    ],
    ROOT / "report.html",
    MEASUREMENTS,
    CALCULATED,
    expand(
        ROOT / "imp/{cost}/{repetition}.{kind}",
        cost=COSTS,
        repetition=REPETITIONS,
        kind=["json", "csv.gz"],
    ),
    expand(ROOT / "tables/{name}.csv", name=SHOWN_TABLES),
    expand(ROOT / "figures/{name}.png", name=SHOWN_FIGURES),
]


include: "rules/archive.smk"
