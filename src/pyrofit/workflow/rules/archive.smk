# All of a study in one file, to be run again elsewhere: snakemake archive
rule archive:
    """Study, results and software in one file."""
    input:
        EVERYTHING,
        given=given.files,
        lock=[name for name in ["requirements.lock"] if os.path.exists(name)],
    output:
        ROOT / f"{study.name}.zip",
    log:
        log_of("archive"),
    localrule: True
    params:
        study=STUDY,
        digest=digest(dependencies.presentation(study)),
        source=SHOWS,
    message:
        "Archive: {output}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " archive --study {params.study} --digest {params.digest} --log {log}"
        " --given {input.given}"
