from pyrofit.analysis.isoconversional.records import applies as has_rates

ISOCONVERSIONAL = []


if has_rates(study):
    ISOCONVERSIONAL = [
        results.isoconversional(name) for name in ("energies.csv", "findings.json")
    ]

    rule isoconversional:
        """Activation energy over conversion, by methods that know no reactions."""
        input:
            MEASUREMENTS,
            (
                results.identification("estimate.csv", "kinetics")
                if study.kinetics
                else results.identification("estimate.csv")
            ),
            plan=plan(
                "isoconversional",
                dependencies.isoconversional_slice,
                "pyrofit.stages.isoconversional",
            ),
        output:
            ISOCONVERSIONAL,
        log:
            log_of("isoconversional"),
        benchmark:
            benchmark_of("isoconversional")
        message:
            "Activation energy over conversion"
        shell:
            '"$PYROFIT_PYTHON" -P -m pyrofit'
            " isoconversional --study {input.plan} --log {log}"
