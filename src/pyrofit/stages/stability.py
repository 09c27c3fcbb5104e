"""Stability of a diagnosis: the same diagnosis on disturbed data."""

from typing import Any

from pyrofit.config import Study
from pyrofit.diagnose.diagnosis import Diagnosis, examine
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.logs import Tell
from pyrofit.results import stability
from pyrofit.results.files import Results
from pyrofit.stages.diagnose import refuse_programs
from pyrofit.stages.measurements import load


def repeat_disturbed(
    study: Study, results: Results, draw: int, tell: Tell, processes: int = 1
) -> None:
    """Diagnose a study on data disturbed by a draw of their noise; write ``stability/draw_k.json``.

    Parameters
    ----------
    study, results
        The study, its measurements prepared.
    draw
        Number of the draw, from 0: it determines the disturbance.
    tell
        Is told the progress.
    processes
        Processes that share the fits; the result does not depend on their number.

    Raises
    ------
    DataError
        A measurement is missing, a channel is too short, or no run within the limits finishes.
    StudyError
        An external program simulates one of its experiments.
    """
    refuse_programs(study)
    found = examine(study, load(study, results), tell, processes, advise=False, draw=draw)
    stability.write(results, _content(study, results, draw, found))


def _content(study: Study, results: Results, draw: int, found: Diagnosis) -> dict[str, Any]:
    verdict, end = found.content["verdict"], found.searched
    return {
        "study": study.name,
        "origin": stability.origin(study, results),
        "draw": draw,
        "disturbance": SETTINGS.disturbance,
        "kind": verdict["kind"],
        "confirmed": verdict["confirmed"],
        "sets": verdict["sets"],
        "reasons": verdict["reasons"],
        "final": list(end.effects),
        "chi2": end.fit.chi2,
        "strengths": {effect: end.strength(effect) for effect in end.effects},
    }
