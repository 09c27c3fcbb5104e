_FILES = ("fit.json", "history.csv.gz", "convergence.csv", "curves.csv", "scores.csv")
_HEAT_FILES = ("heats.csv", "heat_scores.csv") if heats_shown(study) else ()
FITTED_KINETICS = (
    []
    if study.kinetics is None
    else [results.kinetics(name) for name in (*_FILES, *_HEAT_FILES)]
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
            heats=[results.kinetics(name) for name in _HEAT_FILES],
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
            "Kinetics fitted to heated samples"
        shell:
            '"$PYROFIT_PYTHON" -P -m pyrofit'
            " kinetics --study {params.study} --digest {params.digest} --log {log}"
