CALCULATED = [
    results.measurements_summary,
    *FITTED_KINETICS,
    results.imp("summary.csv"),
    results.imp("convergence.csv"),
    STARTED,
    expand(ROOT / "imp/{cost}/descent.json", cost=COSTS),
    IDENTIFICATION,
    ISOCONVERSIONAL,
    PREDICTED,
    COMPARED,
]
SHOWN_TABLES = [name for part in SUBJECTS.values() for name in part.tables_of(study)]
SHOWN_FIGURES = [name for part in SUBJECTS.values() for name in part.figures_of(study)]


# One process makes all of a subject: to start one takes longer than to draw a figure.
for _subject, _part in SUBJECTS.items():
    _tables, _figures = _part.tables_of(study), _part.figures_of(study)
    if not _tables and not _figures:
        continue

    rule:
        name:
            f"show_{_subject}"
        input:
            # Those of the kinetics are drawn before the searches that follow.
            FITTED_KINETICS if _subject == "kinetics" else CALCULATED,
            MEASUREMENTS,
            results.measurements_summary,
            plan=plan(f"show_{_subject}", dependencies.presentation, *_part.modules),
        output:
            tables=[
                reported(ROOT / f"tables/{name}.csv", "table", TABLES, name)
                for name in _tables
            ],
            read=[ROOT / f"tables/{name}.md" for name in _tables],
            figures=[
                reported(ROOT / f"figures/{name}.svg", "figure", FIGURES, name)
                for name in _figures
            ],
            drawn=[ROOT / f"figures/{name}.png" for name in _figures],
        log:
            log_of(f"show_{_subject}"),
        priority: 1
        params:
            subject=_subject,
            shown={
                **{title_in(TABLES, name): TABLES[name].note for name in _tables},
                **{
                    title_in(FIGURES, name): FIGURES[name].caption for name in _figures
                },
            },
        message:
            "Tables and figures, {params.subject}"
        shell:
            '"$PYROFIT_PYTHON" -P -m pyrofit'
            " show --study {input.plan} --log {log}"
            " --subject {params.subject}"


rule report:
    """The report of the study; without a target it is made with all its files."""
    input:
        CALCULATED,
        expand(ROOT / "tables/{name}.md", name=SHOWN_TABLES),
        expand(ROOT / "figures/{name}.svg", name=SHOWN_FIGURES),
        # Once a study has been diagnosed, its report shows that, kept up to date; so with steps.
        [
            results.of_step(name, inputs_of(name).files[-1])
            for name, step in known_steps().items()
            if step.page
            and not inputs_of(name).version
            and exists(study, results, name)
        ],
        [page for page in [results.diagnosis("report.html")] if page.exists()],
        plan=plan("report", dependencies.presentation, *STUDY_MODULES),
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
    localrule: True
    params:
        versions=VERSIONS,
    message:
        "Report: {output.page}"
    shell:
        '"$PYROFIT_PYTHON" -P -m pyrofit report --study {input.plan} --log {log}'
