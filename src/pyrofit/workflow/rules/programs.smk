# What simulates besides pyrofit: files of the user, and the timed run ahead of the campaign.
OUTSIDE = [*PROGRAM_FILES]


if PROGRAMS:
    # Its seconds differ from run to run, which is no reason to run a campaign again.
    OUTSIDE += [ancient(results.programs("trial.json"))]

    rule trial:
        input:
            MEASUREMENTS,
            KINETICS_FOR_IMP,
            PROGRAM_FILES,
            plan=plan("trial", dependencies.trial_slice, "pyrofit.stages.trial"),
        output:
            results.programs("trial.json"),
        log:
            log_of("trial"),
        threads: max(1, workflow.cores or 1)
        message:
            "External programs: one timed run, and what the campaign costs"
        shell:
            '"$PYROFIT_PYTHON" -P -m pyrofit'
            " trial --study {input.plan} --log {log}"
            " --cores {threads}"
