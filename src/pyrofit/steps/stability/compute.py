"""Stability of a diagnosis: the same diagnosis on disturbed data."""

from pyrofit.config import Study
from pyrofit.diagnose.diagnosis import DiagnosisWork, examine
from pyrofit.logs import Tell
from pyrofit.results.files import Results
from pyrofit.results.recorded import load
from pyrofit.stages.diagnose import refuse_programs
from pyrofit.steps.stability import record


def run(study: Study, results: Results, tell: Tell, processes: int, draw: str) -> None:
    """Diagnose a study on data disturbed by a draw of their noise; write ``stability/draw_k.json``.

    Parameters
    ----------
    study, results
        The study, its measurements prepared.
    tell
        Is told the progress.
    processes
        Processes that share the fits; the result does not depend on their number.
    draw
        Number of the draw, from 0: it determines the disturbance.

    Raises
    ------
    DataError
        A measurement is missing, a channel is too short, or no run within the limits finishes.
    StudyError
        An external program simulates one of its experiments.
    """
    refuse_programs(study)
    number = int(draw)
    found = examine(study, load(study, results), tell, processes, advise=False, draw=number)
    record.write(results, _of_draw(study, results, number, found))


def _of_draw(study: Study, results: Results, draw: int, found: DiagnosisWork) -> record.OfDraw:
    verdict, end = found.content.verdict, found.searched
    return record.OfDraw(
        study=study.name,
        origin=record.origin(study, results),
        draw=draw,
        disturbance=end.settings.disturbance,
        kind=verdict.kind,
        confirmed=verdict.confirmed,
        sets=verdict.sets,
        reasons=verdict.reasons,
        final=list(end.effects),
        chi2=end.fit.chi2,
        strengths={effect: end.strength(effect) for effect in end.effects},
    )
