_FILES = ("fit.json", "history.csv.gz", "convergence.csv", "curves.csv", "scores.csv")
FITTED_KINETICS = (
    [] if study.kinetics is None else [results.kinetics(name) for name in _FILES]
)
KINETICS = FITTED_KINETICS[:1]
# The inverse modelling waits for the fit only where it uses it.
KINETICS_FOR_IMP = KINETICS if study.imp.kinetics == "fitted" else []


if study.kinetics is not None:

    rule kinetics:
        input:
            MEASUREMENTS,
        output:
            fit=results.kinetics("fit.json"),
            history=results.kinetics("history.csv.gz"),
            convergence=results.kinetics("convergence.csv"),
            curves=results.kinetics("curves.csv"),
            scores=results.kinetics("scores.csv"),
        log:
            log_of("kinetics"),
        benchmark:
            benchmark_of("kinetics")
        params:
            study=STUDY,
            digest=digest(dependencies.kinetics(study)),
            generations=study.kinetics.sceua.generations,
            seed=study.seed,
            source=FITS,
        message:
            "Kinetics fitted to TGA"
        shell:
            "pyrofit kinetics --study {params.study} --digest {params.digest} --log {log}"
