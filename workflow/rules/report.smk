CALCULATED = [
    results.measurements_summary,
    *FITTED_KINETICS,
    results.imp("summary.csv"),
    results.imp("convergence.csv"),
    STARTED,
    expand(ROOT / "imp/{cost}/descent.json", cost=COSTS),
    IDENTIFICATION,
    PREDICTED,
    COMPARED,
]
SHOWN_TABLES = [name for name, table in TABLES.items() if table.applies(study)]
SHOWN_FIGURES = [name for name, figure in FIGURES.items() if figure.applies(study)]


rule table:
    input:
        CALCULATED,
    output:
        csv=report(
            ROOT / "tables/{name}.csv",
            caption="../report/table.rst",
            category="Tables",
            labels=lambda wildcards: {"table": title_in(TABLES, wildcards.name)},
        ),
        markdown=ROOT / "tables/{name}.md",
    log:
        log_of("table_{name}"),
    wildcard_constraints:
        name="|".join(TABLES),
    params:
        study=STUDY,
        digest=digest(dependencies.presentation(study)),
        note=lambda wildcards: TABLES[wildcards.name].note,
        source=lambda wildcards: source_fingerprint(module_of(wildcards.name)),
    message:
        "Table {wildcards.name}"
    shell:
        "pyrofit table --study {params.study} --digest {params.digest} --log {log}"
        " --name {wildcards.name}"


rule figure:
    input:
        CALCULATED,
        MEASUREMENTS,
    output:
        svg=report(
            ROOT / "figures/{name}.svg",
            caption="../report/figure.rst",
            category="Figures",
            labels=lambda wildcards: {"figure": title_in(FIGURES, wildcards.name)},
        ),
        png=ROOT / "figures/{name}.png",
    log:
        log_of("figure_{name}"),
    wildcard_constraints:
        name="|".join(FIGURES),
    params:
        study=STUDY,
        digest=digest(dependencies.presentation(study)),
        caption=lambda wildcards: FIGURES[wildcards.name].caption,
        source=lambda wildcards: source_fingerprint(module_of(wildcards.name)),
    message:
        "Figure {wildcards.name}"
    shell:
        "pyrofit figure --study {params.study} --digest {params.digest} --log {log}"
        " --name {wildcards.name}"


rule report:
    input:
        CALCULATED,
        expand(ROOT / "tables/{name}.md", name=SHOWN_TABLES),
        expand(ROOT / "figures/{name}.svg", name=SHOWN_FIGURES),
        # Once a study has been diagnosed, its report shows that, kept up to date; so with twins.
        [
            page
            for page in (
                results.diagnosis("report.html"),
                results.robustness("table.csv"),
                results.rescored("valleys.svg"),
                results.scheme("scheme.svg"),
            )
            if page.exists()
        ],
    output:
        page=report(
            ROOT / "report.html",
            caption="../report/page.rst",
            category="Report",
            labels={"page": "the report of the study"},
        ),
        provenance=ROOT / "provenance.json",
    log:
        log_of("report"),
    params:
        study=STUDY,
        digest=digest(dependencies.presentation(study)),
        source=SHOWS,
    message:
        "Report: {output.page}"
    shell:
        "pyrofit report --study {params.study} --digest {params.digest} --log {log}"
