"""Check of the compiler and of the time: a few model calls of each cost are timed."""

import time
from collections.abc import Iterator

import numpy as np

from pyrofit.config import Study, kinetics_of
from pyrofit.config.programs import externals
from pyrofit.errors import PyrofitError
from pyrofit.estimate.pose import of_imp, of_kinetics, pose
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.targets import Measurements
from pyrofit.ready.finding import Finding, Situation
from pyrofit.ready.plan import Part, parts_of
from pyrofit.running.durations import in_words
from pyrofit.running.shares import SIDE_BY_SIDE
from pyrofit.stages.measurements import computed
from pyrofit.stages.reading import read_all

START_S, START_ON_SLURM_S = 3.0, 10.0
"""Time of a job besides its calculation [s]; on a cluster each job starts Snakemake."""
LONG_H = 24.0
"""Duration [h] above which there is a warning."""


def duration(situation: Situation) -> Iterator[Finding]:
    """Compile the solver, time it on each cost, and estimate the duration of the fits."""
    study = situation.study
    if study is None:
        return
    if externals(study):
        text = "external programs are not run here; `pyrofit trial --study FILE` times them"
        yield Finding("warning", "time", text)
        return
    start = time.perf_counter()
    try:
        measured = measurements(study)
        planned = parts_of(study, situation.job_cores)
        timed = [(part, *seconds(_problem(study, part, measured))) for part in planned]
    except PyrofitError as error:
        yield Finding("error", "time", f"the model cannot be timed: {error}")
        return
    except Exception as error:  # the compiler has many kinds of errors
        text = f"{type(error).__name__}: {error}; reinstall with `make .venv/installed`"
        yield Finding("error", "compiler", text)
        return
    took = time.perf_counter() - start
    yield Finding("ok", "compiler", f"the solver runs; compiling and timing took {took:.0f} s")
    yield _estimate(situation, timed)


def _estimate(situation: Situation, timed: list[tuple[Part, float, float]]) -> Finding:
    calls = sum(part.alone + part.together for part, _, _ in timed)
    model = sum(part.alone * alone + part.together * each for part, alone, each in timed)
    jobs = sum(part.jobs for part, _, _ in timed)
    start = START_ON_SLURM_S if situation.on_slurm else START_S
    total = model + jobs * start
    # No job is divided.
    cores = min(situation.cores, jobs)
    text = (
        f"about {in_words(total / cores)} for the fits: ({calls:,.0f} model calls x "
        f"{1e3 * model / calls:.2g} ms + {jobs} jobs x {start:g} s) / {cores} cores. "
        "Tables, figures and a diagnosis are not included"
    )
    if total / cores > 3600.0 * LONG_H:
        way_out = "fewer repetitions, more cores, or a cluster (docs/cluster.md) make it shorter"
        return Finding("warning", "time", f"{text}; {way_out}")
    return Finding("ok", "time", text)


def seconds(problem: Problem) -> tuple[float, float]:
    """Return the time of one model call alone, and in a batch [s].

    The sets are drawn within the limits. The first calls, which may compile, are not timed.
    """
    rng = np.random.default_rng(0)
    span = problem.upper - problem.lower
    sets = problem.lower + span * rng.uniform(0.05, 0.95, (SIDE_BY_SIDE, len(problem.names)))
    problem.evaluate(sets[0])
    problem.evaluate_all(sets)
    start = time.perf_counter()
    problem.evaluate_all(sets)
    together = time.perf_counter()
    for x in sets:
        problem.evaluate(x)
    end = time.perf_counter()
    return (end - together) / len(sets), (together - start) / len(sets)


def measurements(study: Study) -> Measurements:
    """Return the measured series; those to be computed come from the fast solver."""
    measured = {key: frame for key, (frame, _) in read_all(study).items()}
    return measured | (computed(study, fast=True) if study.is_synthetic else {})


def _problem(study: Study, part: Part, measured: Measurements) -> Problem:
    if part.cost:
        asked = of_imp(study, study.imp.costs[part.cost])
    else:
        asked = of_kinetics(study, kinetics_of(study).cost)
    return pose(study, asked, measured, _values(study))


def _values(study: Study) -> dict[str, float]:
    """Return a value of every parameter: the given one, the true one, or the middle."""
    middle = {
        name: 0.5 * sum(p.bounds_si)
        for name, p in study.parameters.items()
        if p.lower is not None and p.upper is not None
    }
    return middle | study.true_values()
