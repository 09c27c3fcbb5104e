# All of a study in one file, to be run again elsewhere: snakemake archive
rule archive:
    """Study, results and software in one file."""
    input:
        EVERYTHING,
        given=given.files,
        lock=[name for name in ["requirements.lock"] if os.path.exists(name)],
        plan=plan("archive", dependencies.presentation, *STUDY_MODULES),
    output:
        ROOT / f"{study.name}.zip",
    log:
        log_of("archive"),
    localrule: True
    message:
        "Archive: {output}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " archive --study {input.plan} --log {log}"
        " --given {input.given}"
