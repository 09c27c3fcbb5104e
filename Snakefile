"""The whole study: data, kinetics, inverse modelling, validation, tables, figures, report."""

import json
import os
import re
import shutil
from pathlib import Path

from snakemake.utils import min_version, update_config

from pyrofit.config import as_study, digest, read_mapping
from pyrofit.config.unmeasured import unmeasured
from pyrofit.errors import PyrofitError
from pyrofit.provenance import STUDY as STUDY_MODULES
from pyrofit.provenance import source_fingerprint
from pyrofit.results import dependencies
from pyrofit.results.files import Results, write_text
from pyrofit.results.kinetics import heats_shown
from pyrofit.show.sections import FIGURES, TABLES, module_of
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
    update_config(given, workflow.config_settings.config)
    study = as_study(given, SOURCE)
    check_measurements(study, SOURCE, macfp=False)
    ROOT = Path("results") / study.name
    # The study as checked and completed, with what --config changed: every step reads this file,
    # and verifies by digest that its part of it is what the rule was planned with.
    STUDY = ROOT / "study.json"
    _text = json.dumps(study.model_dump(mode="json"), indent=1) + "\n"
    _dry = any(
        re.fullmatch("-[A-Za-z]*n[A-Za-z]*|--dry-?run", word) for word in sys.argv
    )
    if not _dry and (not STUDY.exists() or STUDY.read_text() != _text):
        write_text(STUDY, _text)
except PyrofitError as error:
    raise WorkflowError(str(error)) from None

results = Results(ROOT)
# What the fits, and what the report, which states this fingerprint, are made by.
FITS = source_fingerprint("pyrofit.stages.fit")
SHOWS = source_fingerprint(*STUDY_MODULES)
COSTS = list(study.imp.costs)
REPETITIONS = [f"{n:02d}" for n in range(study.imp.repetitions)]


wildcard_constraints:
    cost="|".join(COSTS),


onsuccess:
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
    archive,
    diagnosis_page,
    diagnose,
    fds,
    fds_check,


include: "workflow/rules/common.smk"
include: "workflow/rules/data.smk"
include: "workflow/rules/kinetics.smk"
include: "workflow/rules/imp.smk"
include: "workflow/rules/identify.smk"
include: "workflow/rules/validation.smk"
include: "workflow/rules/comparison.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/robustness.smk"
include: "workflow/rules/scheme.smk"
include: "workflow/rules/fds.smk"
include: "workflow/rules/diagnosis.smk"


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
