SCHEME = [
    results.scheme(name)
    for name in (
        "scheme.json",
        "curves.csv",
        "extended.yaml",
        "schemes.csv",
        "schemes.md",
        "parameters.csv",
        "parameters.md",
        "scheme.svg",
        "scheme.png",
    )
]


rule scheme:
    """The reaction scheme that predicts left-out heating rates best."""
    input:
        MEASUREMENTS,
    output:
        SCHEME,
    log:
        log_of("scheme"),
    benchmark:
        benchmark_of("scheme")
    params:
        study=STUDY,
        digest=digest(dependencies.scheme(study)),
        source=source_fingerprint("pyrofit.stages.scheme", "pyrofit.show.scheme_page"),
    message:
        "Which reaction scheme the thermogravimetric records support"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " scheme --study {params.study} --digest {params.digest} --log {log}"
