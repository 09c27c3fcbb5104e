PREDICTED = [
    results.validation(name)
    for name in (
        "curves.csv",
        "scores.csv",
        *(["unmeasured.csv"] if unmeasured(study) else []),
    )
]


rule predict:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        results.imp("summary.csv"),
        STARTED,
        results.identification("estimate.csv"),
    output:
        PREDICTED,
    log:
        log_of("predict"),
    threads: RUNS_CORES
    params:
        study=STUDY,
        digest=digest(dependencies.validation_slice(study)),
        experiments=" ".join(study.validation.experiments),
        source=source_fingerprint("pyrofit.stages.predict"),
    message:
        "Estimates and best sets simulated at {params.experiments}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " predict --study {params.study} --digest {params.digest} --log {log}"
