"""How the repetitions of the inverse modelling are shared out to jobs; no result depends on it."""

from pyrofit.config import Study
from pyrofit.config.expand.programs import externals
from pyrofit.errors import StudyError

KEY = "repetitions_per_job"
"""Key of ``snakemake --config``; it belongs to a run, not to a study."""
SIDE_BY_SIDE = 32
"""Repetitions that run side by side: the solver is then two to three times as fast."""
ON_A_CLUSTER = 16
"""Repetitions of a job of a cluster."""
LANES = 8
"""Repetitions that fill the lanes of the solver."""
FEW = 3
"""Repetitions that are as fast alone as side by side."""
MOST_JOBS = 40
"""Jobs of repetitions of a study whose repetitions are shared out automatically, about."""
MANY = 2000
"""Repetitions whose plan takes long enough to be announced."""


def jobs_of_repetitions(
    study: Study, wanted: object = None, cores: int | None = None
) -> list[list[int]]:
    """Return the repetitions of each job of a cost function.

    By default a cost has as many jobs as are needed to give every core one, by eights, and at most
    `SIDE_BY_SIDE` share a job. On a cluster sixteen do; up to sixteen are shared out by eights.
    Where that makes more than `MOST_JOBS` jobs, jobs hold several times as many. The rest is a job
    if it is more than `FEW`. Runs of an external program gain nothing side by side: there, each
    repetition is a job.

    Parameters
    ----------
    study
        The study.
    wanted
        Repetitions of a job, a whole number; None shares them out by default.
    cores
        Cores of this machine that run jobs; None on a cluster.

    Raises
    ------
    StudyError
        ``wanted`` is no whole number of at least 1.
    """
    everything = list(range(study.imp.repetitions))
    if wanted is not None:
        return parts_of_repetitions(everything, _whole(wanted))
    if at_once(study) == 1:
        return parts_of_repetitions(everything, 1)
    each = _by_default(len(everything), len(study.imp.costs), cores)
    full = len(everything) - len(everything) % each
    rest = everything[full:]
    return parts_of_repetitions(everything[:full], each) + parts_of_repetitions(
        rest, each if len(rest) > FEW else 1
    )


def _by_default(repetitions: int, costs: int, cores: int | None) -> int:
    """Return how many repetitions share a job, a multiple of `LANES`.

    >>> [_by_default(25, 3, cores) for cores in (1, 2, 5, 6, 12, None)]
    [32, 32, 32, 16, 8, 16]
    """
    if cores is None:
        each = ON_A_CLUSTER if repetitions > ON_A_CLUSTER else LANES
    else:
        per_cost = max(1, cores // costs)
        each = min(LANES * -(-repetitions // (LANES * per_cost)), SIDE_BY_SIDE)
    return each * -(-repetitions * costs // (each * MOST_JOBS))


def at_once(study: Study) -> int:
    """Return how many repetitions of a job run side by side."""
    return 1 if externals(study) else SIDE_BY_SIDE


def parts_of_repetitions(repetitions: list[int], size: int) -> list[list[int]]:
    """Return repetitions in parts of a size, the last one shorter.

    >>> parts_of_repetitions([0, 1, 2, 3, 4], 2)
    [[0, 1], [2, 3], [4]]
    """
    return [repetitions[n : n + size] for n in range(0, len(repetitions), size)]


def _whole(wanted: object) -> int:
    text = str(wanted)
    if not text.isdecimal() or int(text) < 1:
        raise StudyError(
            f"--config {KEY}={text}: not a whole number of at least 1; leave it out to share the "
            "repetitions out by default"
        )
    return int(text)


def long_plan(study: Study) -> str:
    """Say that planning many repetitions takes long; nothing where there are few."""
    count = study.imp.repetitions * len(study.imp.costs)
    if count <= MANY:
        return ""
    return (
        f"planning {count:,} repetitions: nothing else is told for some minutes. "
        "`imp.repetitions` says how many; 5 to 1000 are usual"
    )
