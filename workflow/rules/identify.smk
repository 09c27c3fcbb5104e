IDENTIFICATION = [
    results.identification(f"{name}.csv")
    for name in (
        "estimate",
        "sensitivities",
        "singular_values",
        "correlation",
        "profiles",
        "sets",
    )
] + [results.identification("noise.json")]


rule identify:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        results.imp("summary.csv"),
        expand(ROOT / "imp/{cost}/least_squares.json", cost=COSTS),
    output:
        IDENTIFICATION,
    log:
        log_of("identify"),
    benchmark:
        benchmark_of("identify")
    params:
        digest=digest(slices.identify(study)),
        source=COMPUTES,
    message:
        "What the data determine"
    shell:
        "pyrofit identify --study {STUDY} --digest {params.digest} --log {log}"
