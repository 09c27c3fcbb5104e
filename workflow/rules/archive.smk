# All of a study in one file, to be run again elsewhere: snakemake archive
rule archive:
    input:
        rules.all.input,
        given=workflow.configfiles,
        lock="requirements.lock",
    output:
        ROOT / f"{study.name}.zip",
    log:
        log_of("archive"),
    params:
        study=STUDY,
        digest=digest(dependencies.presentation(study)),
        source=SHOWS,
    message:
        "Archive: {output}"
    shell:
        "pyrofit archive --study {params.study} --digest {params.digest} --log {log}"
        " --given {input.given}"
