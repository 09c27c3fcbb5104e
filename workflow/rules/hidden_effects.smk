from pyrofit.hidden.places import FOLDER, Places
from pyrofit.hidden.setting import read_setting
from pyrofit.figures.hidden_effects import HIDDEN_FIGURES

HIDDEN_EFFECTS = "config/hidden_effects.yaml"
try:
    blind = read_setting(Path(HIDDEN_EFFECTS))
    BLIND = digest(
        [blind.model_dump(exclude={"plans"}), read_mapping(Path(blind.base))]
    )
except PyrofitError as error:
    raise WorkflowError(str(error)) from None


# A twin that has been diagnosed is a file of its own, which no rule removes: after a stop, a job
# goes on with the next.
rule hidden_effects_chunk:
    output:
        places_of("{plan}").root / "chunks/{chunk}.json",
    log:
        FOLDER / "{plan}/logs/{chunk}.log",
    benchmark:
        FOLDER / "{plan}/benchmarks/{chunk}.tsv"
    wildcard_constraints:
        plan="|".join(blind.plans),
        chunk=r"\d+",
    params:
        setting=HIDDEN_EFFECTS,
        digest=blind_digest,
        source=COMPUTES,
    message:
        "Blind test of the diagnosis, plan {wildcards.plan}, job {wildcards.chunk}"
    shell:
        "pyrofit hidden-effects --setting {params.setting} --plan {wildcards.plan}"
        " --chunk {wildcards.chunk} --log {log}"


rule hidden_effects_page:
    input:
        chunks_of,
    output:
        page=FOLDER / "{plan}/page.md",
        tables=[
            FOLDER / f"{{plan}}/tables/{name}.csv"
            for name in ("twins", "rates", "by_detectability", "middles")
        ],
        figures=[
            FOLDER / f"{{plan}}/figures/{name}.{kind}"
            for name in HIDDEN_FIGURES
            for kind in ("svg", "png")
        ],
    log:
        FOLDER / "{plan}/logs/page.log",
    wildcard_constraints:
        plan="|".join(blind.plans),
    params:
        setting=HIDDEN_EFFECTS,
        digest=blind_digest,
        source=SHOWS,
    message:
        "Blind test of the diagnosis, plan {wildcards.plan}: tables, figures, page"
    shell:
        "pyrofit hidden-effects --setting {params.setting} --plan {wildcards.plan}"
        " --log {log}"


rule hidden_effects:
    input:
        FOLDER / "full/page.md",


rule hidden_effects_short:
    input:
        FOLDER / "short/page.md",
