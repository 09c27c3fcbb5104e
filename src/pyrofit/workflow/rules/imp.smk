# Their names are written out: among thousands, Snakemake looks long for a rule with wildcards.
for _cost, _together in product(COSTS, SHARES):

    rule:
        name:
            f"imp_{_cost}_{_together[0]}"
        input:
            MEASUREMENTS,
            KINETICS_FOR_IMP,
            OUTSIDE,
            plan=plan(f"imp_{_cost}", dependencies.imp, FITS, of=[_cost, "sceua"]),
        output:
            expand(
                ROOT / f"imp/{_cost}/{{repetition}}{{suffix}}",
                repetition=_together,
                suffix=[".csv.gz", "_convergence.csv", ".json"],
            ),
        log:
            log_of(f"imp_{_cost}_{_together[0]}"),
        benchmark:
            benchmark_of(f"imp_{_cost}_{_together[0]}")
        # The longest jobs begin first; shorter ones fill the cores beside the last of them.
        priority: 2
        threads: RUN_CORES
        params:
            cost=_cost,
            # Derived from the output: sharing out otherwise runs nothing again.
            repetitions=lambda wildcards, output: repetitions_in(output),
        message:
            f"Inverse modelling, {_cost}, repetition "
            + " to ".join(dict.fromkeys([_together[0], _together[-1]]))
        shell:
            '"$PYROFIT_PYTHON" -P -m pyrofit'
            " imp --study {input.plan} --log {log}"
            " --cost {params.cost} --repetition {params.repetitions}"


rule optimise:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        plan=lambda wildcards: plan(
            f"{wildcards.optimiser}_{wildcards.cost}",
            dependencies.imp,
            FITS,
            of=[wildcards.cost, wildcards.optimiser],
        ),
    output:
        ROOT / "imp/{cost}/{optimiser}.json",
    log:
        log_of("{optimiser}_{cost}"),
    benchmark:
        benchmark_of("{optimiser}_{cost}")
    wildcard_constraints:
        optimiser="|".join(OPTIMISERS),
    threads: RUNS_CORES
    params:
        command=lambda wildcards: OPTIMISERS[wildcards.optimiser].command,
        title=lambda wildcards: OPTIMISERS[wildcards.optimiser].title,
    message:
        "{params.title}, {wildcards.cost}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " {params.command} --study {input.plan} --log {log}"
        " --cost {wildcards.cost}"


rule descent:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        results.imp("summary.csv"),
        plan=lambda wildcards: plan(
            f"descent_{wildcards.cost}",
            dependencies.imp,
            FITS,
            of=[wildcards.cost, "least_squares"],
        ),
    output:
        ROOT / "imp/{cost}/descent.json",
    log:
        log_of("descent_{cost}"),
    threads: RUNS_CORES
    message:
        "Least squares from SCE-UA's best set, {wildcards.cost}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " descent --study {input.plan} --log {log}"
        " --cost {wildcards.cost}"


rule collect:
    input:
        expand(
            ROOT / "imp/{cost}/{repetition}.json", cost=COSTS, repetition=REPETITIONS
        ),
        expand(
            ROOT / "imp/{cost}/{repetition}_convergence.csv",
            cost=COSTS,
            repetition=REPETITIONS,
        ),
        plan=plan("collect", dependencies.collect_slice, FITS),
    output:
        summary=results.imp("summary.csv"),
        convergence=results.imp("convergence.csv"),
    log:
        log_of("collect"),
    localrule: True
    message:
        "All repetitions gathered"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit collect --study {input.plan} --log {log}'
