MEASUREMENTS = [
    results.measurement(name, signal)
    for name, experiment in study.experiments.items()
    for signal in experiment.signals
]


rule prepare:
    input:
        study.own_files,
        PROGRAM_FILES if study.is_synthetic else [],
    output:
        series=MEASUREMENTS,
        summary=results.measurements_summary,
    log:
        log_of("prepare"),
    localrule: True
    params:
        study=STUDY,
        digest=digest(dependencies.data_slice(study)),
        files=study.needs_macfp,
        source=source_fingerprint("pyrofit.stages.measurements"),
    message:
        "Measured series into tidy tables, mass closure checked"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " prepare --study {params.study} --digest {params.digest} --log {log}"
