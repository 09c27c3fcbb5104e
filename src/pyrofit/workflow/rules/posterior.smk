"""Draws from the posterior of the parameters and predictions with bands; a target of its own."""

from pyrofit.results import posterior


rule posterior:
    """Samples of the posterior, predictions with bands."""
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        FITS_FOR_NOISE,
        results.identification("estimate.csv"),
        results.identification("noise.json"),
    output:
        [
            results.posterior(name)
            for name in (
                "posterior.json",
                "samples.csv.gz",
                "ensemble.csv",
                "bands.csv",
                "correlation.csv",
                "bands.svg",
                "parameters.svg",
            )
        ],
        directory(results.posterior("sets")),
    log:
        log_of("posterior"),
    benchmark:
        benchmark_of("posterior")
    threads: 2
    params:
        study=STUDY,
        digest=digest(posterior.slice_of(study)),
        source=source_fingerprint(
            "pyrofit.stages.posterior", "pyrofit.show.posterior_page"
        ),
    message:
        "Parameters drawn from the posterior, and predictions with bands"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " posterior {params.study} --digest {params.digest} --log {log}"
        " --cores {threads}"
