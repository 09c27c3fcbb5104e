"""Check of the compiler and of the time: model calls and the analysis of a signal are timed."""

import time
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from pyrofit.config import Study, kinetics_of
from pyrofit.config.expand.programs import externals
from pyrofit.doctor.finding import ReadyLine, Situation
from pyrofit.doctor.plan import PartOfSearches, parts_of
from pyrofit.doctor.whole_run import (
    PartOfRun,
    beside_the_fits,
    duration_of,
    processor_s,
    start_of_a_step,
)
from pyrofit.errors import PyrofitError
from pyrofit.estimate.coarse import for_search
from pyrofit.estimate.pose import of_imp, of_kinetics, pose
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.targets import Measurements
from pyrofit.running.durations import in_words
from pyrofit.running.shares import SIDE_BY_SIDE
from pyrofit.stages.measurements import computed
from pyrofit.stages.reading import read_all

START_ON_SLURM_S = 10.0
"""Time of a step besides its calculation [s] on a cluster, where each starts Snakemake."""
SEARCHED = 2.0
"""Time of a search over that of its model calls: the optimiser's own work."""
SHARED = 1.3
"""Time that passes over that of the processor above which other work is told."""
LONG_H = 24.0
"""Duration [h] above which there is a warning."""


class Timed(NamedTuple):
    """A fit with the times of its model calls [s]."""

    part: PartOfSearches
    alone: float
    """Of a call alone."""
    together: float
    """Of one of several at once."""
    exact: float
    """The same of one that is never coarser."""

    @property
    def seconds(self) -> float:
        """Time of all calls [s]."""
        part = self.part
        return part.alone * self.alone + part.together * self.together + part.exact * self.exact


def duration(situation: Situation) -> Iterator[ReadyLine]:
    """Compile the solver, time it on each cost, and estimate the duration of the run."""
    study = situation.study
    if study is None:
        return
    if externals(study):
        text = "external programs are not run here; `pyrofit trial --study FILE` times them"
        yield ReadyLine("warning", "time", text)
        return
    start, worked = time.perf_counter(), processor_s()
    try:
        measured = measurements(study)
        planned = parts_of(study, situation.job_cores)
        timed = [timed_part(part, _problem(study, part, measured)) for part in planned]
        call_s = timed[-1].exact
        beside = list(beside_the_fits(study, measured, _values(study), call_s))
    except PyrofitError as error:
        yield ReadyLine("error", "time", f"the model cannot be timed: {error}")
        return
    except Exception as error:  # the compiler has many kinds of errors
        text = f"{type(error).__name__}: {error}; reinstall with `make .venv/installed`"
        yield ReadyLine("error", "compiler", text)
        return
    begin = START_ON_SLURM_S if situation.on_slurm else start_of_a_step()
    took = time.perf_counter() - start
    slower = took / max(processor_s() - worked, 1e-3)
    yield ReadyLine("ok", "compiler", f"the solver runs; compiling and timing took {took:.0f} s")
    yield estimate_of(situation, timed, beside, begin, 1.0 if situation.on_slurm else slower)


def estimate_of(
    situation: Situation,
    timed: Sequence[Timed],
    beside: list[PartOfRun],
    start: float,
    slower: float = 1.0,
) -> ReadyLine:
    """Return the estimated duration of a run, and its share in model calls.

    All times are of a processor that nobody shares.

    Parameters
    ----------
    situation
        Study and machine.
    timed
        The fits with the times of their calls.
    beside
        Other work of the run.
    start
        Start of a job [s].
    slower
        Time that passes over that of the processor, as others share it now.
    """
    calls = sum(fit.part.calls for fit in timed)
    model = sum(fit.seconds for fit in timed)
    # Nothing but its analysis runs beside the fit of the kinetics.
    fits = [PartOfRun(SEARCHED * f.seconds, f.part.jobs, alone=not f.part.cost) for f in timed]
    total = duration_of([*fits, *beside], situation.cores, start)
    steps = sum(work.jobs for work in [*fits, *beside])
    rest = sum(work.seconds for work in beside)
    shared = f", {in_words(slower * total)} beside the work of now" if slower > SHARED else ""
    text = (
        f"about {in_words(total)} for the run on {situation.cores} cores{shared}. "
        f"{calls:,.0f} model calls x {1e3 * model / calls:.2g} ms are for the searches, "
        f"{in_words(rest)} for their analysis and figures, {steps} x {start:.2g} s to begin a "
        "step. A diagnosis is not included"
    )
    if total > 3600.0 * LONG_H:
        way_out = "fewer repetitions, more cores, or a cluster (docs/cluster.md) make it shorter"
        return ReadyLine("warning", "time", f"{text}; {way_out}")
    return ReadyLine("ok", "time", text)


def timed_part(part: PartOfSearches, problem: Problem) -> Timed:
    """Time the calls of a fit; those of searches with the coarser runs that they take."""
    alone, exact = seconds(problem)
    rough = for_search(problem)
    if rough is problem:
        return Timed(part, alone, exact, exact)
    return Timed(part, *seconds(rough), exact)


def seconds(problem: Problem) -> tuple[float, float]:
    """Return the processor's time of one model call alone, and in a batch [s].

    The sets are drawn within the limits. The first calls, which may compile, are not timed.
    """
    rng = np.random.default_rng(0)
    span = problem.upper - problem.lower
    sets = problem.lower + span * rng.uniform(0.05, 0.95, (SIDE_BY_SIDE, len(problem.names)))
    problem.evaluate(sets[0])
    problem.evaluate_all(sets)
    start = processor_s()
    problem.evaluate_all(sets)
    together = processor_s()
    for x in sets:
        problem.evaluate(x)
    end = processor_s()
    return (end - together) / len(sets), (together - start) / len(sets)


def measurements(study: Study) -> Measurements:
    """Return the measured series; those to be computed come from the fast solver."""
    measured = {key: frame for key, (frame, _) in read_all(study).items()}
    return measured | (computed(study, fast=True) if study.is_synthetic else {})


def _problem(study: Study, part: PartOfSearches, measured: Measurements) -> Problem:
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
