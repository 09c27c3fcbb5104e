_SEARCHED = ("fit.json", "history.csv.gz", "convergence.csv")
_HEAT_FILES = ("heats.csv", "heat_scores.csv") if heats_shown(study) else ()
SHOWN_KINETICS = [
    results.kinetics(name)
    for name in ("sets.json", "curves.csv", "scores.csv", *_HEAT_FILES)
]
FITTED_KINETICS = (
    []
    if study.kinetics is None
    else [*(results.kinetics(name) for name in _SEARCHED), *SHOWN_KINETICS]
)
KINETICS = FITTED_KINETICS[:1]
# The inverse modelling waits for the estimates only where it uses them.
KINETICS_FOR_IMP = (
    [results.identification("estimate.csv", "kinetics")]
    if study.imp.kinetics == "fitted"
    else []
)


if study.kinetics is not None:

    rule kinetics:
        input:
            MEASUREMENTS,
            plan=plan("kinetics", dependencies.kinetics, FITS),
        output:
            fit=results.kinetics("fit.json"),
            history=results.kinetics("history.csv.gz"),
            convergence=results.kinetics("convergence.csv"),
        log:
            log_of("kinetics"),
        benchmark:
            benchmark_of("kinetics")
        message:
            "Kinetics fitted to heated samples"
        shell:
            '"$PYROFIT_PYTHON" -P -m pyrofit'
            " kinetics --study {input.plan} --log {log}"
