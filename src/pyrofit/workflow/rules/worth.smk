"""By how much planned tests would narrow parameters and predictions; a target of its own."""

from pyrofit.results import worth


rule worth:
    """What planned tests would tell about parameters and predictions."""
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        FITS_FOR_NOISE,
        results.identification("estimate.csv"),
    output:
        [results.worth(name) for name in ("worth.json", "worth.svg")],
    log:
        log_of("worth"),
    benchmark:
        benchmark_of("worth")
    threads: 2
    params:
        study=STUDY,
        digest=digest(worth.slice_of(study)),
        source=source_fingerprint("pyrofit.stages.worth", "pyrofit.show.worth_page"),
    message:
        "Worth of planned tests"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " worth {params.study} --digest {params.digest} --log {log} --cores {threads}"
