IDENTIFICATION = identification("imp", "sets")


rule identify:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        results.imp("summary.csv"),
        STARTED,
        plan=plan("identify", dependencies.identify_slice, "pyrofit.stages.identify"),
    output:
        identification("imp", "sets"),
    log:
        log_of("identify"),
    benchmark:
        benchmark_of("identify")
    threads: RUNS_CORES
    message:
        "What the data determine of the inverse modelling"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit identify --study {input.plan} --log {log}'


if study.kinetics is not None:
    IDENTIFICATION += identification("kinetics")

    rule identify_kinetics:
        input:
            MEASUREMENTS,
            KINETICS,
            plan=plan(
                "identify_kinetics",
                dependencies.kinetics,
                "pyrofit.stages.identify",
            ),
        output:
            identification("kinetics"),
            SHOWN_KINETICS,
        log:
            log_of("identify_kinetics"),
        benchmark:
            benchmark_of("identify_kinetics")
        # The searches of the inverse modelling wait for it.
        priority: 3
        message:
            "What the data determine of the kinetics"
        shell:
            '"$PYROFIT_PYTHON" -P -m pyrofit'
            " identify --stage kinetics --study {input.plan} --log {log}"
