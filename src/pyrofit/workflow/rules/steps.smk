"""Steps that a study may go without, each a target of its own, as each declares itself."""

from functools import partial

# What steps read, by the names that they use.
READ = {
    "measurements": MEASUREMENTS,
    "kinetics": KINETICS_FOR_IMP,
    "programs": OUTSIDE,
    # The truth of twins, where the measurements have none.
    "truth": [] if study.synthetic else [results.imp("summary.csv")],
    "fits_for_noise": FITS_FOR_NOISE,
    "estimate": results.identification("estimate.csv"),
    "noise": results.identification("noise.json"),
    "searches": expand(
        ROOT / "imp/{cost}/{repetition}{suffix}",
        cost=COSTS,
        repetition=REPETITIONS,
        suffix=[".csv.gz", ".json"],
    ),
    "diagnosis": DIAGNOSIS,
}


def files_of_step(step, name):
    """Return the files that a step leaves."""
    inputs = inputs_of(name)
    folders = [directory(results.of_step(name, folder)) for folder in inputs.folders]
    return [*(results.of_step(name, file) for file in inputs.files), *folders]


def plan_of_part(name, wildcards):
    step, part = known_steps()[name], wildcards.part
    return plan(f"{name}_{part}", slice_of, f"{step.package}.compute", of=[name, part])


for _name, _step in known_steps().items():
    _inputs = inputs_of(_name)
    _parts = results.of_step(_name, _inputs.part_file)

    if not _step.part:

        rule:
            name:
                _name
            input:
                [READ[group] for group in _inputs.reads],
                plan=plan(_name, slice_of, *_step.modules, of=[_name]),
            output:
                files_of_step(_step, _name),
            log:
                log_of(_name),
            benchmark:
                benchmark_of(_name)
            priority: 10 if _step.early else 0
            threads: _step.threads
            params:
                step=_name,
                said=_step.message,
            message:
                "{params.said}"
            shell:
                '"$PYROFIT_PYTHON" -P -m pyrofit'
                " {params.step} {input.plan} --log {log}"
                " --cores {threads}"

    else:

        rule:
            name:
                f"{_name}_of_{_step.part}"
            input:
                [READ[group] for group in _inputs.reads],
                plan=partial(plan_of_part, _name),
            output:
                str(_parts),
            log:
                log_of(f"{_name}_{{part}}"),
            benchmark:
                benchmark_of(f"{_name}_{{part}}")
            wildcard_constraints:
                part="|".join(_inputs.parts(study)),
            threads: RUNS_CORES
            params:
                step=_name,
                option=_step.part,
            message:
                _step.part_message
            shell:
                '"$PYROFIT_PYTHON" -P -m pyrofit'
                " {params.step} {input.plan} --log {log}"
                " --{params.option} {wildcards.part}"

        rule:
            name:
                _name
            input:
                [READ[group] for group in _inputs.gathers],
                expand(_parts, part=_inputs.parts(study)),
                plan=plan(_name, dependencies.presentation, *_step.modules),
            output:
                files_of_step(_step, _name),
            log:
                log_of(_name),
            localrule: True
            params:
                step=_name,
                said=_step.message,
            message:
                "{params.said}"
            shell:
                '"$PYROFIT_PYTHON" -P -m pyrofit'
                " {params.step} {input.plan} --log {log}"
