COMPARED = [results.comparison(f"{name}.csv") for name in ("scores", "family", "bands")]


rule compare:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        results.imp("summary.csv"),
        STARTED,
        plan=plan("compare", dependencies.compare_slice, "pyrofit.stages.compare"),
    output:
        COMPARED,
    log:
        log_of("compare"),
    benchmark:
        benchmark_of("compare")
    threads: RUNS_CORES
    message:
        "All sets of all optimisers under all costs"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit compare --study {input.plan} --log {log}'
