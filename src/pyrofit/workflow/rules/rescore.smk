"""Stored sets scored again under other costs; a target of its own."""

from pyrofit.results import rescored


rule rescore:
    """Stored sets of parameters under other costs."""
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        FITS_FOR_NOISE,
        expand(
            ROOT / "imp/{cost}/{repetition}{suffix}",
            cost=COSTS,
            repetition=REPETITIONS,
            suffix=[".csv.gz", ".json"],
        ),
    output:
        [
            results.rescored(name)
            for name in (
                "rescore.json",
                "sets.csv.gz",
                "scores.csv.gz",
                "correlation.csv",
                "correlation_best.csv",
                "excess.csv",
                "better.csv",
                "agreement.svg",
                "agreement_best.svg",
                "regret.svg",
                "valleys.svg",
            )
        ],
    log:
        log_of("rescore"),
    benchmark:
        benchmark_of("rescore")
    threads: 2
    params:
        study=STUDY,
        digest=digest(rescored.slice_of(study)),
        source=source_fingerprint("pyrofit.stages.rescore", "pyrofit.show.rescore_page"),
    message:
        "Stored sets scored again under other costs"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " rescore {params.study} --digest {params.digest} --log {log}"
        " --cores {threads}"
