DIAGNOSIS = results.diagnosis("diagnosis.json")


rule diagnosis:
    input:
        MEASUREMENTS,
        plan=plan("diagnosis", dependencies.diagnose_slice, "pyrofit.stages.diagnose"),
    output:
        DIAGNOSIS,
        results.diagnosis("curves.csv"),
    log:
        log_of("diagnosis"),
    benchmark:
        benchmark_of("diagnosis")
    threads: 2
    message:
        "Which effect the model lacks"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " diagnose --study {input.plan} --log {log}"
        " --cores {threads}"


rule diagnosis_page:
    input:
        MEASUREMENTS,
        DIAGNOSIS,
        results.diagnosis("curves.csv"),
        plan=plan(
            "diagnosis_page",
            dependencies.presentation,
            "pyrofit.show.diagnosis_page",
        ),
    output:
        results.diagnosis("report.html"),
    log:
        log_of("diagnosis_page"),
    localrule: True
    threads: 2
    params:
        versions=VERSIONS,
    message:
        "Diagnosis: {output}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " diagnosis-page --study {input.plan} --log {log}"
        " --cores {threads}"


rule diagnose:
    """Which physical effect the model lacks."""
    input:
        results.diagnosis("report.html"),
    localrule: True
