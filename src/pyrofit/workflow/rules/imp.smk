# Their names are written out: among thousands, Snakemake looks long for a rule with wildcards.
for _cost, _together in product(COSTS, SHARES):

    rule:
        name:
            f"imp_{_cost}_{_together[0]}"
        input:
            MEASUREMENTS,
            KINETICS_FOR_IMP,
            OUTSIDE,
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
            study=STUDY,
            digest=digest(dependencies.imp(study, _cost, "sceua")),
            generations=study.imp.sceua.generations,
            seed=study.seed,
            source=FITS,
            cost=_cost,
            # Derived from the output: sharing out otherwise runs nothing again.
            repetitions=lambda wildcards, output: repetitions_in(output),
        message:
            f"Inverse modelling, {_cost}, repetition "
            + " to ".join(dict.fromkeys([_together[0], _together[-1]]))
        shell:
            '"$PYROFIT_PYTHON" -P -m pyrofit'
            " imp --study {params.study} --digest {params.digest} --log {log}"
            " --cost {params.cost} --repetition {params.repetitions}"


rule optimise:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
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
        study=STUDY,
        digest=lambda wildcards: digest(
            dependencies.imp(study, wildcards.cost, wildcards.optimiser)
        ),
        starts=lambda wildcards: getattr(study.imp, wildcards.optimiser).starts,
        seed=study.seed,
        source=FITS,
        command=lambda wildcards: OPTIMISERS[wildcards.optimiser].command,
        title=lambda wildcards: OPTIMISERS[wildcards.optimiser].title,
    message:
        "{params.title}, {wildcards.cost}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " {params.command} --study {params.study} --digest {params.digest} --log {log}"
        " --cost {wildcards.cost}"


rule descent:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        OUTSIDE,
        results.imp("summary.csv"),
    output:
        ROOT / "imp/{cost}/descent.json",
    log:
        log_of("descent_{cost}"),
    threads: RUNS_CORES
    params:
        study=STUDY,
        digest=lambda wildcards: digest(
            dependencies.imp(study, wildcards.cost, "least_squares")
        ),
        source=FITS,
    message:
        "Least squares from SCE-UA's best set, {wildcards.cost}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " descent --study {params.study} --digest {params.digest} --log {log}"
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
    output:
        summary=results.imp("summary.csv"),
        convergence=results.imp("convergence.csv"),
    log:
        log_of("collect"),
    localrule: True
    params:
        study=STUDY,
        digest=digest(dependencies.collect_slice(study)),
        source=FITS,
    message:
        "All repetitions gathered"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit'
        " collect --study {params.study} --digest {params.digest} --log {log}"
