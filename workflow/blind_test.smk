"""The blind test of the diagnosis, apart from all studies: plan full, or `short` for a few twins."""

from pathlib import Path

from snakemake.utils import min_version

from pyrofit.blind_test.figures import FIGURES
from pyrofit.blind_test.places import FOLDER, Places
from pyrofit.blind_test.run import code_fingerprint
from pyrofit.blind_test.setting import plan_digest, read_setting
from pyrofit.errors import PyrofitError
from pyrofit.provenance import source_fingerprint

min_version("9.27")


SETTING = "config/blind_test.yaml"
try:
    setting = read_setting(Path(SETTING))
    DIGESTS = {plan: plan_digest(setting, plan) for plan in setting.plans}
except PyrofitError as error:
    raise WorkflowError(str(error)) from None


wildcard_constraints:
    plan="|".join(setting.plans),


# Short steps, which on a cluster run where Snakemake was started.
localrules:
    full,
    short,
    page,


rule full:
    default_target: True
    input:
        FOLDER / "full/page.md",


rule short:
    input:
        FOLDER / "short/page.md",


# Each diagnosed twin is a file of its own, which no rule removes: after a stop, a job goes on with
# its next twin.
rule chunk:
    output:
        FOLDER / "{plan}/chunks/{chunk}.json",
    log:
        FOLDER / "{plan}/logs/{chunk}.log",
    benchmark:
        FOLDER / "{plan}/benchmarks/{chunk}.tsv"
    wildcard_constraints:
        chunk=r"\d+",
    params:
        setting=SETTING,
        digest=lambda wildcards: DIGESTS[wildcards.plan],
        source=code_fingerprint(),
    message:
        "Blind test of the diagnosis, plan {wildcards.plan}, job {wildcards.chunk}"
    shell:
        "pyrofit blind-test --setting {params.setting} --plan {wildcards.plan}"
        " --chunk {wildcards.chunk} --log {log}"


rule page:
    input:
        lambda wildcards: Places(FOLDER / wildcards.plan).chunks(
            setting.plan(wildcards.plan).chunks
        ),
    output:
        page=FOLDER / "{plan}/page.md",
        tables=[
            FOLDER / f"{{plan}}/tables/{name}.csv"
            for name in ("twins", "rates", "by_detectability", "middles")
        ],
        figures=[
            FOLDER / f"{{plan}}/figures/{name}.{kind}"
            for name in FIGURES
            for kind in ("svg", "png")
        ],
    log:
        FOLDER / "{plan}/logs/page.log",
    params:
        setting=SETTING,
        digest=lambda wildcards: DIGESTS[wildcards.plan],
        source=source_fingerprint("pyrofit.blind_test.page"),
    message:
        "Blind test of the diagnosis, plan {wildcards.plan}: tables, figures, page"
    shell:
        "pyrofit blind-test --setting {params.setting} --plan {wildcards.plan} --log {log}"
