DIAGNOSIS = results.diagnosis("diagnosis.json")


rule diagnosis:
    input:
        MEASUREMENTS,
    output:
        DIAGNOSIS,
        results.diagnosis("curves.csv"),
    log:
        log_of("diagnosis"),
    benchmark:
        benchmark_of("diagnosis")
    threads: 2
    params:
        study=STUDY,
        digest=digest(dependencies.diagnose_slice(study)),
        source=source_fingerprint("pyrofit.stages.diagnose"),
    message:
        "Which effect the model lacks"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " diagnose --study {params.study} --digest {params.digest} --log {log}"
        " --cores {threads}"


rule diagnosis_page:
    input:
        MEASUREMENTS,
        DIAGNOSIS,
        results.diagnosis("curves.csv"),
    output:
        results.diagnosis("report.html"),
    log:
        log_of("diagnosis_page"),
    localrule: True
    threads: 2
    params:
        study=STUDY,
        digest=digest(dependencies.presentation(study)),
        source=source_fingerprint("pyrofit.show.diagnosis_page"),
        versions=VERSIONS,
    message:
        "Diagnosis: {output}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " diagnosis-page --study {params.study} --digest {params.digest} --log {log}"
        " --cores {threads}"


rule diagnose:
    """Which physical effect the model lacks."""
    input:
        results.diagnosis("report.html"),
    localrule: True
