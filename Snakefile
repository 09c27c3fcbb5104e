"""The whole study: data, kinetics, inverse modelling, validation, tables, figures, report."""

import os
import shutil
import signal
import sys
from itertools import product
from pathlib import Path

from snakemake.logging import logger
from snakemake.utils import min_version, update_config

from pyrofit.running.interrupt import end_while_starting, end_with_jobs

if workflow.is_main_process:  # before slow imports: Ctrl-C says one line from here on
    end_while_starting()

from pyrofit.config import as_study, digest, read_mapping
from pyrofit.config.programs import externals, program_files
from pyrofit.config.unmeasured import unmeasured
from pyrofit.config.unusual import unusual
from pyrofit.errors import PyrofitError
from pyrofit.provenance import STUDY as STUDY_MODULES
from pyrofit.provenance import source_fingerprint
from pyrofit.results import dependencies
from pyrofit.results.files import Results
from pyrofit.results.kinetics import heats_shown
from pyrofit.running import causes, shares
from pyrofit.estimate.calls import calls_of_jobs
from pyrofit.running.frozen import freeze, frozen_study
from pyrofit.running.lock import end_run, join_run, start_run
from pyrofit.running.work import WorkDone
from pyrofit.show.sections import FIGURES, SUBJECTS, TABLES
from pyrofit.stages.reading import check_measurements

min_version("9.27")


report: "workflow/report/workflow.rst"


# A given --configfile replaces the default study; Snakemake alone would merge the two.
DEFAULT_STUDY = "config/twin.yaml"
if not workflow.configfiles:

    configfile: DEFAULT_STUDY


SOURCE = os.path.relpath(workflow.configfiles[0])
try:
    # Not Snakemake's `config`: to that, a key may stand twice, and 1e-3 is text.
    given = {}
    for path in workflow.configfiles:
        update_config(given, read_mapping(Path(os.path.relpath(path))))
    # How repetitions are shared out to jobs belongs to the run, not to the study.
    settings = dict(workflow.config_settings.config)
    per_job = settings.pop(shares.KEY, None)
    update_config(given, settings)
    if workflow.is_main_process:
        study = as_study(given, SOURCE)
        check_measurements(study, SOURCE, macfp=False)
    else:  # a job of a cluster: the study file may have been edited since the start
        study = frozen_study(given, SOURCE)
    ROOT = Path("results") / study.name
    # A job of a cluster must share out as the process that submitted it.
    local = workflow.is_main_process and workflow.local_exec
    cores = workflow.resource_settings.cores if local else None
    SHARES = [[f"{n:02d}" for n in job] for job in shares.shares(study, per_job, cores)]
    if workflow.is_main_process:
        logger.addHandler(WorkDone(calls_of_jobs(study, SHARES), cores))
    else:
        join_run(ROOT)
except PyrofitError as error:
    raise WorkflowError(str(error)) from None

# The study as checked and completed, with the changes of --config. Every step reads this file, and
# verifies by digest that its part of it did not change after the rule was planned.
STUDY = ROOT / "study.json"
results = Results(ROOT)
# What the fits, and what the report, which states this fingerprint, are made by.
FITS = source_fingerprint("pyrofit.stages.fit")
SHOWS = source_fingerprint(*STUDY_MODULES)
COSTS = list(study.imp.costs)
# Inputs of external programs, and the cores of their simultaneous runs.
PROGRAM_FILES = list(program_files(study))
PROGRAMS = [experiment.program for experiment in externals(study).values()]
RUN_CORES = max([program.cores for program in PROGRAMS], default=1)
RUNS_CORES = max([p.parallel * p.cores for p in PROGRAMS], default=1)
OLD_LOGS = causes.logs()
REPETITIONS = [repetition for job in SHARES for repetition in job]


wildcard_constraints:
    cost="|".join(COSTS),


onstart:
    try:
        if told := start_run(ROOT):
            print(told, file=sys.stderr)
        for sentence in unusual(study):
            print(f"warning: {SOURCE}: {sentence}", file=sys.stderr)
        freeze(study, STUDY)
        if workflow.local_exec:
            end_with_jobs(ROOT)
        else:  # Snakemake cancels the jobs of a cluster
            signal.signal(signal.SIGINT, signal.default_int_handler)
    except PyrofitError as error:
        raise WorkflowError(str(error)) from None


onerror:
    for _cause in causes.causes(OLD_LOGS):
        print(_cause, file=sys.stderr)
    end_run(ROOT)


onsuccess:
    end_run(ROOT)
    for _page in (ROOT / "report.html", results.diagnosis("report.html")):
        if _page.exists():
            print(f"Page: {_page}")


# Short steps, which on a cluster run where Snakemake was started.
localrules:
    all,
    prepare,
    collect,
    report,
    robustness,
    stability,
    archive,
    diagnosis_page,
    diagnose,
    fds,
    fds_check,


include: "workflow/rules/common.smk"
include: "workflow/rules/data.smk"
include: "workflow/rules/kinetics.smk"
include: "workflow/rules/programs.smk"
include: "workflow/rules/imp.smk"
include: "workflow/rules/identify.smk"
include: "workflow/rules/validation.smk"
include: "workflow/rules/comparison.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/robustness.smk"
include: "workflow/rules/rescore.smk"
include: "workflow/rules/sensitivity.smk"
include: "workflow/rules/posterior.smk"
include: "workflow/rules/worth.smk"
include: "workflow/rules/scheme.smk"
include: "workflow/rules/fds.smk"
include: "workflow/rules/diagnosis.smk"
include: "workflow/rules/stability.smk"


# Everything, not the report alone: what is deleted or was removed with a failed run is made again.
rule all:
    default_target: True
    input:
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


include: "workflow/rules/archive.smk"
