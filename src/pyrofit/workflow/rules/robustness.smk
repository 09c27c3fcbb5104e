rule robustness_of_cost:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        # The truth of the twins, where the measurements have none.
        [] if study.synthetic else [results.imp("summary.csv")],
    output:
        ROOT / "robustness/{cost}.csv",
    log:
        log_of("robustness_{cost}"),
    benchmark:
        benchmark_of("robustness_{cost}")
    threads: RUNS_CORES
    params:
        study=STUDY,
        digest=lambda wildcards: digest(dependencies.robustness(study, wildcards.cost)),
        source=source_fingerprint("pyrofit.stages.robustness"),
    message:
        "Robustness, {wildcards.cost}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " robustness --study {params.study} --digest {params.digest} --log {log}"
        " --cost {wildcards.cost}"


rule robustness:
    """Cost functions on synthetic data with noise and outliers."""
    input:
        expand(ROOT / "robustness/{cost}.csv", cost=COSTS),
    output:
        [
            results.robustness(name)
            for name in ("table.csv", "table.md", "robustness.svg", "robustness.png")
        ],
    log:
        log_of("robustness"),
    localrule: True
    params:
        study=STUDY,
        digest=digest(dependencies.presentation(study)),
        source=source_fingerprint("pyrofit.show.robustness"),
    message:
        "Robustness of the cost functions: table and figure"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " robustness --study {params.study} --digest {params.digest} --log {log}"
