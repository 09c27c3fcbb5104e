"""How the repetitions of the inverse modelling are shared out to jobs; no result depends on it."""

from pyrofit.config import Study
from pyrofit.config.programs import externals
from pyrofit.errors import StudyError

KEY = "repetitions_per_job"
"""Key of ``snakemake --config``; it belongs to a run, not to a study."""
SIDE_BY_SIDE = 16
"""Repetitions that run side by side: the solver is then two to three times as fast."""
FEW = 3
"""Repetitions that are as fast alone as side by side."""
MOST_JOBS = 40
"""Jobs of repetitions of a study whose repetitions are shared out automatically, about."""


def shares(study: Study, wanted: object = None) -> list[list[int]]:
    """Return the repetitions of each job of a cost function.

    By default, sixteen share a job, and so does the rest if it is more than `FEW`. Up to sixteen
    are shared out by eights, so that two cores have work. Where that makes more than `MOST_JOBS`
    jobs, jobs hold several sixteens. Runs of an external program gain nothing side by side: there,
    each repetition is a job. More repetitions run no full job again.

    Parameters
    ----------
    study
        The study.
    wanted
        Repetitions of a job, a whole number; None shares them out by default.

    Raises
    ------
    StudyError
        ``wanted`` is no whole number of at least 1.
    """
    everything = list(range(study.imp.repetitions))
    if wanted is not None:
        return parts(everything, _whole(wanted))
    if at_once(study) == 1:
        return parts(everything, 1)
    each = SIDE_BY_SIDE if len(everything) > SIDE_BY_SIDE else SIDE_BY_SIDE // 2
    each *= -(-len(everything) * len(study.imp.costs) // (each * MOST_JOBS))
    full = len(everything) - len(everything) % each
    rest = everything[full:]
    return parts(everything[:full], each) + parts(rest, each if len(rest) > FEW else 1)


def at_once(study: Study) -> int:
    """Return how many repetitions of a job run side by side."""
    return 1 if externals(study) else SIDE_BY_SIDE


def parts(repetitions: list[int], size: int) -> list[list[int]]:
    """Return repetitions in parts of a size, the last one shorter.

    >>> parts([0, 1, 2, 3, 4], 2)
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
