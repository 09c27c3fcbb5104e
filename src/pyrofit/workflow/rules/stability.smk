"""The diagnosis on disturbed data; a target of its own, one job for each draw."""


rule stability_of_draw:
    input:
        MEASUREMENTS,
    output:
        ROOT / "stability/draw_{draw}.json",
    log:
        log_of("stability_{draw}"),
    benchmark:
        benchmark_of("stability_{draw}")
    wildcard_constraints:
        draw=r"\d+",
    params:
        study=STUDY,
        digest=digest(dependencies.diagnose(study)),
        source=source_fingerprint("pyrofit.stages.stability"),
    message:
        "Diagnosis of disturbed data, draw {wildcards.draw}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " stability --study {params.study} --digest {params.digest} --log {log}"
        " --draw {wildcards.draw}"


rule stability:
    """The diagnosis on slightly changed data."""
    input:
        DIAGNOSIS,
        expand(ROOT / "stability/draw_{draw}.json", draw=range(study.diagnosis.draws)),
    output:
        [
            results.stability(name)
            for name in (
                "table_effects.csv",
                "table_effects.md",
                "table_draws.csv",
                "table_draws.md",
                "stability.svg",
                "stability.png",
                stability_results.GATHERED,
            )
        ],
    log:
        log_of("stability"),
    localrule: True
    params:
        study=STUDY,
        digest=digest(dependencies.presentation(study)),
        source=source_fingerprint("pyrofit.show.stability_page"),
    message:
        "Stability of the diagnosis: tables and figure"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " stability --study {params.study} --digest {params.digest} --log {log}"
