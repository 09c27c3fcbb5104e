"""The diagnosis of a study, from its measurements to the verdict."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pandas as pd

from pyrofit.config import Study, candidate_effects
from pyrofit.diagnose.advise.free_corrections import Probe, probes
from pyrofit.diagnose.advise.separation import next_experiments
from pyrofit.diagnose.base.accuracy import solver_error, tolerated_error
from pyrofit.diagnose.base.fit import Setup, set_up
from pyrofit.diagnose.base.fitted import FittedModel, resting_at_limits, up_to_date
from pyrofit.diagnose.base.journal import Journal
from pyrofit.diagnose.base.model import Base
from pyrofit.diagnose.judge.final_fits import final_fits
from pyrofit.diagnose.judge.findings import Verdict
from pyrofit.diagnose.judge.profiles import profiles
from pyrofit.diagnose.judge.verdict import judge
from pyrofit.diagnose.result import record
from pyrofit.diagnose.search.kinetics_first import kinetics_first
from pyrofit.diagnose.search.progress import Whole
from pyrofit.diagnose.search.step import SearchContext, in_order
from pyrofit.diagnose.search.stepwise import Search, search_effects
from pyrofit.diagnose.settings import Settings
from pyrofit.estimate.targets import Measurements
from pyrofit.logs import Tell
from pyrofit.results.diagnosis_schema import Diagnosis as Record
from pyrofit.results.diagnosis_schema import OfSolver

Based = Callable[[Study], tuple[Setup, np.random.Generator]]
"""Makes the fitted base model of a study, and the generator of the draws that judge it."""


@dataclass(frozen=True, eq=False)
class DiagnosisWork:
    """A search, the verdict on it, and both as tidy results.

    ``searched`` is the model that the search ended with, ``search`` ends with the one that the
    tests of a claim leave. ``end`` is that model, fitted with runs as fine as the study asks for.
    """

    searched: FittedModel
    search: Search
    end: FittedModel
    verdict: Verdict
    content: Record
    curves: pd.DataFrame


def examine(
    study: Study,
    measurements: Measurements,
    tell: Tell = lambda text: None,
    processes: int = 1,
    advise: bool = True,
    draw: int | None = None,
    journal: Journal | None = None,
    settings: Settings = Settings(),
) -> DiagnosisWork:
    """Find where a study's model and measurements disagree, and which effect the model lacks.

    Parameters
    ----------
    study
        The study; ``diagnosis`` names the fitted and held-out signals, and the candidate effects.
    measurements
        Measured series by (experiment, signal), SI units.
    tell
        Is told the progress.
    processes
        Processes that share the fits; the result does not depend on their number.
    advise
        Whether to look for free corrections and the next experiment as well.
    draw
        Number of the draw of noise that disturbs the data, see `disturbed`; by default none does.
    journal
        Keeps descents, so that a diagnosis that is broken off goes on with them.
    settings
        Numbers that steer the diagnosis.

    Raises
    ------
    DataError
        A channel is too short, or no run within the limits finishes.
    """
    based = partial(_based, measurements, tell, processes, draw, journal, settings)
    found, rng, solver = _searched(study, based, tell, processes, Whole())
    searched = found.end
    verdict = judge(found, rng, processes)
    found = verdict.search
    final = final_fits(verdict, study.accuracy if solver.coarsened else None, processes)
    content = record.content(study, found, verdict, final, solver, processes)
    end = final.of(found.end)
    if advise:
        content = record.advised(
            content,
            profiles(end, processes),
            _probes(found, verdict, processes),
            next_experiments(undecided_models(found, verdict), processes),
        )
    tell(content.verdict.words)
    return DiagnosisWork(searched, found, end, verdict, content, record.curve_records(found, final))


def diagnose(study: Study, measurements: Measurements) -> Record:
    """Return the record of a diagnosis, without advice."""
    return examine(study, measurements, advise=False).content


def _searched(
    study: Study, based: Based, tell: Tell, processes: int, whole: Whole
) -> tuple[Search, np.random.Generator, OfSolver]:
    """Return the search, the generator of its draws, and how accurate its runs are.

    Runs are coarser than the study asks for, unless the difference counts against the noise.
    """

    def context(setup: Setup, rng: np.random.Generator) -> SearchContext:
        return SearchContext(rng, tell, processes, setup.other_starts, whole=whole)

    rough = study.model_copy(update={"accuracy": study.accuracy.coarsened()})
    setup, rng = based(rough)
    error = solver_error(setup.base, study.accuracy)
    tolerated = tolerated_error(setup.base)
    if error <= tolerated:
        found = _search(rough, setup, context(setup, rng))
        error = max(error, solver_error(found.end, study.accuracy))
        if error <= tolerated:
            return found, rng, OfSolver(coarsened=True, error_chi2=error)
    tell(f"once more with finer runs, which change chi-square by {error:.2g}")
    setup, rng = based(study)
    found = _search(study, setup, context(setup, rng))
    return found, rng, OfSolver(coarsened=False, error_chi2=0.0)


def _based(
    measurements: Measurements,
    tell: Tell,
    processes: int,
    draw: int | None,
    journal: Journal | None,
    settings: Settings,
    study: Study,
) -> tuple[Setup, np.random.Generator]:
    """Return the fitted base model, and the generator of the draws that judge it."""
    kinetics = study.kinetics.estimate if study.kinetics else ()

    def narrowed(base: Base) -> Base:
        kept = replace(base, journal=journal)
        return kinetics_first(kept, kinetics, candidate_effects(study), study.seed, processes)

    setup = set_up(study, measurements, processes, draw, narrowed, settings)
    tell(f"base model: chi-square {setup.base.fit.chi2:.1f} of {setup.base.model.points} points")
    resting = resting_at_limits(setup.base)
    if resting:
        tell(f"base model: {', '.join(resting)} at a limit; a missing effect may be the reason")
    return setup, np.random.default_rng(study.seed)


def _search(study: Study, setup: Setup, context: SearchContext) -> Search:
    return search_effects(setup.base, setup.candidates, study.diagnosis.most_effects, context)


def _probes(found: Search, verdict: Verdict, processes: int) -> list[Probe]:
    return probes(found.end, processes) if verdict.kind in ("partly", "unknown") else []


def undecided_models(found: Search, verdict: Verdict) -> list[FittedModel]:
    """Return the models that are not told apart, or else the two best of different effects.

    None where nothing is missing.
    """
    if verdict.kind == "none":
        return []
    for finding in verdict.findings:
        if len(finding.kept) > 1:
            return [judged.trial for judged in finding.kept]
        if finding.instead:
            return [found.end, finding.instead[0].trial]
    best: dict[frozenset[str], FittedModel] = {}
    for trial in in_order(found.trials):
        best.setdefault(frozenset(trial.effects), trial)
    return [up_to_date(trial) for trial in list(best.values())[:2]]
