FDS_NEEDS = [KINETICS_FOR_IMP, results.imp("summary.csv"), STARTED, IDENTIFICATION]


rule fds_export:
    input:
        FDS_NEEDS,
        plan=plan(
            "fds_export",
            dependencies.presentation,
            "pyrofit_exchange.fds.export",
        ),
    output:
        results.fds("{version}/material.fds"),
        results.fds("{version}/export.json"),
    log:
        log_of("fds_export_{version}"),
    wildcard_constraints:
        version=r"6\.\d+",
    params:
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    message:
        "The fitted material for FDS {wildcards.version}: {output[0]}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " export fds {input.plan} --fds-version {wildcards.version}"
        " --out {params.folder} --log {log}"


rule fds:
    """The fitted material as input files of FDS."""
    input:
        expand(results.fds("{version}/material.fds"), version=["6.7", "6.8"]),
    localrule: True


rule fds_check_run:
    input:
        FDS_NEEDS,
        plan=plan("fds_check", dependencies.presentation, "pyrofit_exchange.fds.check"),
    output:
        results.fds("check.json"),
        results.fds("check.md"),
    log:
        log_of("fds_check"),
    benchmark:
        benchmark_of("fds_check")
    params:
        # Another FDS, or none, is another proof.
        fds=os.environ.get("PYROFIT_FDS") or shutil.which("fds") or "none",
    message:
        "FDS beside pyrofit: {output[1]}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit fds-check --study {input.plan} --log {log}'


rule fds_check:
    """The fitted material in your FDS, beside pyrofit."""
    input:
        results.fds("check.json"),
    localrule: True
