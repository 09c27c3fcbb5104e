IDENTIFICATION = identification("imp", "sets")


rule identify:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        results.imp("summary.csv"),
        STARTED,
    output:
        identification("imp", "sets"),
    log:
        log_of("identify"),
    benchmark:
        benchmark_of("identify")
    threads: RUNS_CORES
    params:
        study=STUDY,
        digest=digest(dependencies.identify_slice(study)),
        source=source_fingerprint("pyrofit.stages.identify"),
    message:
        "What the data determine of the inverse modelling"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " identify --study {params.study} --digest {params.digest} --log {log}"


if study.kinetics is not None:
    IDENTIFICATION += identification("kinetics")

    rule identify_kinetics:
        input:
            MEASUREMENTS,
            KINETICS,
        output:
            identification("kinetics"),
            SHOWN_KINETICS,
        log:
            log_of("identify_kinetics"),
        benchmark:
            benchmark_of("identify_kinetics")
        # The searches of the inverse modelling wait for it.
        priority: 3
        params:
            study=STUDY,
            digest=digest(dependencies.kinetics(study)),
            source=source_fingerprint("pyrofit.stages.identify"),
        message:
            "What the data determine of the kinetics"
        shell:
            '"$PYROFIT_PYTHON" -P -m pyrofit'
            " identify --stage kinetics --study {params.study} --digest {params.digest}"
            " --log {log}"
