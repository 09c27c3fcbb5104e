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
        plan=plan("predict", dependencies.validation_slice, "pyrofit.stages.predict"),
    output:
        PREDICTED,
    log:
        log_of("predict"),
    threads: RUNS_CORES
    params:
        experiments=" ".join(study.validation.experiments),
    message:
        "Estimates and best sets simulated at {params.experiments}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit predict --study {input.plan} --log {log}'
