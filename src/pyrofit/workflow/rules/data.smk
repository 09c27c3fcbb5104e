MEASUREMENTS = [
    results.measurement(name, signal)
    for name, experiment in study.experiments.items()
    for signal in experiment.signals
]


rule prepare:
    input:
        study.own_files,
        PROGRAM_FILES if study.is_synthetic else [],
        plan=plan("prepare", dependencies.data_slice, "pyrofit.stages.measurements"),
    output:
        series=MEASUREMENTS,
        summary=results.measurements_summary,
    log:
        log_of("prepare"),
    localrule: True
    message:
        "Measured series into tidy tables, mass closure checked"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit prepare --study {input.plan} --log {log}'
