COMPARED = [results.comparison(f"{name}.csv") for name in ("scores", "family", "bands")]


rule compare:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        results.imp("summary.csv"),
        STARTED,
    output:
        COMPARED,
    log:
        log_of("compare"),
    benchmark:
        benchmark_of("compare")
    threads: RUNS_CORES
    params:
        study=STUDY,
        digest=digest(dependencies.compare_slice(study)),
        source=source_fingerprint("pyrofit.stages.compare"),
    message:
        "All sets of all optimisers under all costs"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " compare --study {params.study} --digest {params.digest} --log {log}"
