"""The blind tests of the diagnosis, apart from all studies.

Targets: full (the plan full of blind_test.yaml), short (a few of its twins), foreign (the plan full
of foreign_truth.yaml), foreign_part (a part of it), gpyro (the plan full of gpyro_truth.yaml).
"""

import os
import sys
from pathlib import Path

from snakemake.utils import min_version

from pyrofit_blind_test.figures import FIGURES
from pyrofit_blind_test.page import TABLES
from pyrofit_blind_test.places import RESULTS, Places, folder_of
from pyrofit_blind_test.run import code_fingerprint
from pyrofit_blind_test.setting import plan_digest, read_setting
from pyrofit.errors import PyrofitError
from pyrofit.provenance import source_fingerprint

min_version("9.27")

os.environ.update(PYROFIT_PYTHON=sys.executable)  # of jobs


TESTS = {
    name: Path("config") / f"{name}.yaml"
    for name in ("blind_test", "foreign_truth", "gpyro_truth")
}
try:
    SETTINGS = {name: read_setting(path) for name, path in TESTS.items()}
    DIGESTS = {
        (name, plan): plan_digest(setting, plan)
        for name, setting in SETTINGS.items()
        for plan in setting.plans
    }
except PyrofitError as error:
    raise WorkflowError(str(error)) from None


wildcard_constraints:
    test="|".join(TESTS),
    plan=r"\w+",


# Short steps, which on a cluster run where Snakemake was started.
localrules:
    full,
    short,
    foreign,
    foreign_part,
    gpyro,
    page,


rule full:
    default_target: True
    input:
        folder_of(TESTS["blind_test"], "full") / "page.md",


rule short:
    input:
        folder_of(TESTS["blind_test"], "short") / "page.md",


rule foreign:
    input:
        folder_of(TESTS["foreign_truth"], "full") / "page.md",


rule foreign_part:
    input:
        folder_of(TESTS["foreign_truth"], "part") / "page.md",


rule gpyro:
    input:
        folder_of(TESTS["gpyro_truth"], "full") / "page.md",


# Each diagnosed twin is a file of its own, which no rule removes: after a stop, a job goes on with
# its next twin.
rule chunk:
    output:
        RESULTS / "{test}/{plan}/chunks/{chunk}.json",
    log:
        RESULTS / "{test}/{plan}/logs/{chunk}.log",
    benchmark:
        RESULTS / "{test}/{plan}/benchmarks/{chunk}.tsv"
    wildcard_constraints:
        chunk=r"\d+",
    params:
        setting=lambda wildcards: TESTS[wildcards.test],
        digest=lambda wildcards: DIGESTS[wildcards.test, wildcards.plan],
        source=code_fingerprint(),
    message:
        "Blind test of the diagnosis, {wildcards.test}, plan {wildcards.plan},"
        " job {wildcards.chunk}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " blind-test --setting {params.setting} --plan {wildcards.plan}"
        " --chunk {wildcards.chunk} --log {log}"


rule page:
    input:
        lambda wildcards: Places(
            folder_of(TESTS[wildcards.test], wildcards.plan)
        ).chunks(SETTINGS[wildcards.test].plan(wildcards.plan).chunks),
    output:
        page=RESULTS / "{test}/{plan}/page.md",
        tables=[RESULTS / f"{{test}}/{{plan}}/tables/{name}.csv" for name in TABLES],
        figures=[
            RESULTS / f"{{test}}/{{plan}}/figures/{name}.{kind}"
            for name in FIGURES
            for kind in ("svg", "png")
        ],
    log:
        RESULTS / "{test}/{plan}/logs/page.log",
    params:
        setting=lambda wildcards: TESTS[wildcards.test],
        digest=lambda wildcards: DIGESTS[wildcards.test, wildcards.plan],
        source=source_fingerprint("pyrofit_blind_test.page"),
    message:
        "Blind test of the diagnosis, {wildcards.test}, plan {wildcards.plan}: tables, figures, page"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " blind-test --setting {params.setting} --plan {wildcards.plan} --log {log}"
