"""What signals and costs depend on, over time; a target of its own."""

from pyrofit.results import sensitivity


rule sensitivity:
    """Influence of each parameter on signals over time and on costs."""
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        FITS_FOR_NOISE,
    output:
        [
            results.sensitivity(name)
            for name in (
                "sensitivity.json",
                "curves.csv.gz",
                "over_time.csv.gz",
                "costs.csv",
                "total.svg",
                "apparatus.svg",
                "first.svg",
                "costs.svg",
            )
        ],
    log:
        log_of("sensitivity"),
    benchmark:
        benchmark_of("sensitivity")
    threads: 2
    params:
        study=STUDY,
        digest=digest(sensitivity.slice_of(study)),
        source=source_fingerprint(
            "pyrofit.stages.sensitivity", "pyrofit.show.sensitivity_page"
        ),
    message:
        "Sensitivity of signals over time and of costs"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " sensitivity {params.study} --digest {params.digest} --log {log}"
        " --cores {threads}"
