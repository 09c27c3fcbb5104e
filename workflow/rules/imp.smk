rule imp:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
    output:
        history=ROOT / "imp/{cost}/{repetition}.csv.gz",
        convergence=ROOT / "imp/{cost}/{repetition}_convergence.csv",
        result=ROOT / "imp/{cost}/{repetition}.json",
    log:
        log_of("imp_{cost}_{repetition}"),
    benchmark:
        benchmark_of("imp_{cost}_{repetition}")
    params:
        study=STUDY,
        digest=lambda wildcards: digest(slices.imp(study, wildcards.cost, "sceua")),
        generations=study.imp.sceua.generations,
        seed=study.seed,
        source=COMPUTES,
    message:
        "Inverse modelling, {wildcards.cost}, repetition {wildcards.repetition}"
    shell:
        "pyrofit imp --study {params.study} --digest {params.digest} --log {log}"
        " --cost {wildcards.cost} --repetition {wildcards.repetition}"


rule least_squares:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
    output:
        ROOT / "imp/{cost}/least_squares.json",
    log:
        log_of("least_squares_{cost}"),
    benchmark:
        benchmark_of("least_squares_{cost}")
    params:
        study=STUDY,
        digest=lambda wildcards: digest(
            slices.imp(study, wildcards.cost, "least_squares")
        ),
        starts=study.imp.least_squares.starts,
        seed=study.seed,
        source=COMPUTES,
    message:
        "Multistart least squares, {wildcards.cost}"
    shell:
        "pyrofit least-squares --study {params.study} --digest {params.digest} --log {log}"
        " --cost {wildcards.cost}"


rule cma_es:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
    output:
        ROOT / "imp/{cost}/cmaes.json",
    log:
        log_of("cmaes_{cost}"),
    benchmark:
        benchmark_of("cmaes_{cost}")
    params:
        study=STUDY,
        digest=lambda wildcards: digest(slices.imp(study, wildcards.cost, "cmaes")),
        starts=study.imp.cmaes.starts,
        seed=study.seed,
        source=COMPUTES,
    message:
        "CMA-ES, {wildcards.cost}"
    shell:
        "pyrofit cma-es --study {params.study} --digest {params.digest} --log {log}"
        " --cost {wildcards.cost}"


rule descent:
    input:
        MEASUREMENTS,
        KINETICS_FOR_IMP,
        results.imp("summary.csv"),
    output:
        ROOT / "imp/{cost}/descent.json",
    log:
        log_of("descent_{cost}"),
    params:
        study=STUDY,
        digest=lambda wildcards: digest(
            slices.imp(study, wildcards.cost, "least_squares")
        ),
        source=COMPUTES,
    message:
        "Least squares from SCE-UA's best set, {wildcards.cost}"
    shell:
        "pyrofit descent --study {params.study} --digest {params.digest} --log {log}"
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
    params:
        study=STUDY,
        digest=digest(slices.collect(study)),
        source=COMPUTES,
    message:
        "All repetitions gathered"
    shell:
        "pyrofit collect --study {params.study} --digest {params.digest} --log {log}"
