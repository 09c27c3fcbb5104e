"""How long a whole run takes: steps that all others wait for, and steps side by side."""

import os
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from pyrofit.analysis.good_sets import SWEEPS, WALKERS
from pyrofit.config import Study
from pyrofit.estimate.channel_noise import noise_of
from pyrofit.estimate.likelihood import DESCENTS
from pyrofit.estimate.pose import Estimation, of_imp, of_kinetics, pose
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.targets import Measurements

SNAKEMAKE_S = 1.0
"""Time that Snakemake needs for a step [s]."""
ANALYSIS = 2.2
"""Time of an analysis of a likelihood over that of the noise of its signals; 2.1 was measured."""
ITERATIONS = 20
"""Steps of a descent."""
KERNELS = 2.0
"""Time of Python, imports and compiled code over that without compiled code."""
SHOWN, DRAWN_S = 8, 2.0
"""Steps that draw tables and figures, and the time that they draw [s]."""
COMPUTED_S = 2.0
"""Time in which the reference solver computes the signals of an experiment [s]."""
BESIDE_SEARCHES = 2
"""Steps that gather or predict, beside the analysis and the searches."""
_IMPORTS = "import pyrofit.stages.identify, pyrofit.show.sections"


@dataclass(frozen=True)
class PartOfRun:
    """Some steps of a run.

    Parameters
    ----------
    seconds
        Time of their calculation, together [s].
    jobs
        Number of steps.
    alone
        Whether the others wait for them; else they run side by side.
    """

    seconds: float
    jobs: int = 1
    alone: bool = False


def duration_of(works: Iterable[PartOfRun], cores: int, start: float) -> float:
    """Return the duration of a run [s]: steps alone, and the others shared by the cores.

    >>> works = [PartOfRun(10.0, alone=True), PartOfRun(40.0, jobs=4)]
    >>> duration_of(works, 2, 1.0)
    33.0
    """
    every = list(works)
    beside = [work for work in every if not work.alone]
    jobs = sum(work.jobs for work in beside)
    alone = sum(work.seconds + work.jobs * start for work in every if work.alone)
    shared = sum(work.seconds + work.jobs * start for work in beside)
    return alone + shared / max(min(cores, jobs), 1)


def processor_s() -> float:
    """Return the processor's time of this process, and of those that it has started [s]."""
    others = os.times()
    return time.process_time() + others.children_user + others.children_system


def start_of_a_step() -> float:
    """Return the processor's time in which a step begins [s]: Python, its imports, Snakemake."""
    begin = processor_s()
    subprocess.run([sys.executable, "-P", "-c", _IMPORTS], check=False, capture_output=True)
    return KERNELS * (processor_s() - begin) + SNAKEMAKE_S


def beside_the_fits(
    study: Study, measured: Measurements, values: Mapping[str, float], call_s: float
) -> Iterator[PartOfRun]:
    """Yield the steps of a run that are no searches.

    Parameters
    ----------
    study, measured
        The study and its data.
    values
        A value of every parameter, SI units.
    call_s
        Time of a model call in a batch [s].
    """
    computed = {
        name for name, e in study.experiments.items() if _is_computed(study, name, e.signals)
    }
    yield PartOfRun(COMPUTED_S * len(computed), jobs=2, alone=True)  # reading, gathering
    if study.kinetics is not None:
        yield PartOfRun(analysis_s(study, of_kinetics(study), measured, values), alone=True)
    estimation = of_imp(study)
    seconds = analysis_s(study, estimation, measured, values)
    n = len(estimation.names)
    seconds += (DESCENTS + n) * ITERATIONS * (n + 1) * call_s
    yield PartOfRun(seconds, alone=True)
    costs = len(study.imp.costs)
    yield PartOfRun(costs * WALKERS * SWEEPS * call_s, jobs=1 + costs)
    yield PartOfRun(DRAWN_S * SHOWN, jobs=BESIDE_SEARCHES + SHOWN)
    yield PartOfRun(0.0, alone=True)  # the report


def _is_computed(study: Study, name: str, signals: Iterable[str]) -> bool:
    return any(study.is_computed(name, signal) for signal in signals)


def analysis_s(
    study: Study, estimation: Estimation, measured: Measurements, values: Mapping[str, float]
) -> float:
    """Return the processor's time of the analysis of a likelihood [s], from one signal's noise.

    The signal has the median number of points. Where a signal jumps, its noise is found twice.
    """
    problem = pose(study, estimation, measured, values)
    points = _points(problem)
    middle = sorted(range(len(points)), key=lambda k: points[k])[len(points) // 2]
    begin = processor_s()
    noise_of(problem, middle)
    a_point = (processor_s() - begin) / points[middle]
    jumps = [problem.runs[name].experiment.jumps for name, _, _ in problem.picks]
    noise = sum(n * (2 if jump else 1) for n, jump in zip(points, jumps, strict=True))
    return a_point * (noise + (ANALYSIS - 1.0) * sum(points))


def _points(problem: Problem) -> list[int]:
    return [term.target.time_s.size for _, term in problem.cost.terms]
