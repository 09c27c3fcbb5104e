"""Before a campaign with external programs: one timed run of each, and the estimated duration."""

from collections.abc import Iterator, Mapping

import numpy as np

from pyrofit.analysis.good_sets import SWEEPS, WALKERS
from pyrofit.config import Study, TermSpec
from pyrofit.config.expand.programs import externals
from pyrofit.errors import ProgramError
from pyrofit.estimate.calls import optimiser_calls, sceua_calls
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.estimate.targets import Measurements
from pyrofit.experiments import kind_of
from pyrofit.experiments.base import Asked
from pyrofit.experiments.external.simulate import last_needed
from pyrofit.external.filled import executable_digest, executable_of, file_digests
from pyrofit.external.runs import Outcome, outcomes
from pyrofit.model.external import ExternalExperiment
from pyrofit.results.files import Results
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.results.record import write_record
from pyrofit.results.recorded import load
from pyrofit.results.trial import TimedRun, Trial
from pyrofit.running.durations import in_words
from pyrofit.seeds import seed_for

DRAWS = 4
"""Largest number of drawn sets that are tried if the middle of the limits fails."""
ANALYSIS = 200
"""Typical number of calls for each derivative in the analysis of the determined parameters."""


def trial(study: Study, results: Results, cores: int) -> list[str]:
    """Run every program once, write ``programs/trial.json``, and estimate the duration.

    A program runs with the middle of the limits, else with sets that are drawn within them.

    Parameters
    ----------
    study
        The study, whose programs keep their runs.
    results
        Its results.
    cores
        Cores that the campaign will have.

    Raises
    ------
    ProgramError
        A program is missing, or fails with every set.
    """
    found = {name: _tried(study, results, name, e) for name, e in externals(study).items()}
    seconds = {name: one.seconds for name, one in found.items()}
    calls = list(planned_calls(study))
    hours = sum(n * _seconds(study, terms, seconds) for _, n, terms in calls) / 3600.0
    by_search = {label: round(n) for label, n, _ in calls}
    content = Trial(experiments=found, calls=by_search, core_hours=hours)
    write_record(results.programs("trial.json"), content)
    return list(_sentences(content, cores))


def _tried(study: Study, results: Results, name: str, experiment: ExternalExperiment) -> TimedRun:
    """Return the record of a program after one run."""
    program = experiment.program
    outcome = _first_success(study, results, name, experiment)
    return TimedRun(
        command=list(program.command),
        executable=executable_of(program).name,
        sha256=executable_digest(program),
        version=outcome.version,
        files=file_digests(program),
        seconds=outcome.seconds,
        time_limit_s=program.time_limit_s,
    )


def _first_success(
    study: Study, results: Results, name: str, experiment: ExternalExperiment
) -> Outcome:
    measurements = load(study, results)
    quantities = {s: experiment.quantity(s) for s in experiment.program.reads}
    needed = last_needed(experiment, measured_times(experiment, name, measurements))
    fixed = fixed_for_imp(study, results)
    reasons: list[str] = []
    for values in _sets(study):
        outcome = outcomes(
            experiment.program, quantities, needed, [{**fixed, **values}], again=True
        )[0]
        if not outcome.why:
            return outcome
        if outcome.why in reasons:
            break
        reasons.append(outcome.why)
    folder = experiment.program.store
    raise ProgramError(
        f"experiments.{name}: the program fails: {'; '.join(reasons)}. Correct template or command"
        + (f"; {folder}/failed shows the runs" if folder else "")
    )


def measured_times(experiment: ExternalExperiment, name: str, measurements: Measurements) -> Asked:
    """Return the requests at all measured times by signal."""
    kind = kind_of(experiment)
    frames = {s: measurements[name, s] for s in experiment.signals}
    return {
        s: kind.request(experiment, s, frame, frame["time_s"].to_numpy(float))
        for s, frame in frames.items()
    }


def _sets(study: Study) -> Iterator[dict[str, float]]:
    """Yield the middle of the limits, then some drawn sets."""
    bounds = np.array([study.parameters[n].bounds_si for n in study.imp.estimate])
    rng = np.random.default_rng(seed_for(study.seed, "programs", "trial"))
    places = np.vstack([np.full(len(bounds), 0.5), rng.uniform(size=(DRAWS, len(bounds)))])
    for u in places:
        x = bounds[:, 0] + u * (bounds[:, 1] - bounds[:, 0])
        yield dict(zip(study.imp.estimate, x.tolist(), strict=True))


def planned_calls(study: Study) -> Iterator[tuple[str, float, tuple[TermSpec, ...]]]:
    """Yield planned searches: label, approximate number of model calls, simulated terms.

    SCE-UA makes (2n + 1) c (1 + 1.63 (g - 1)) calls with n parameters, c complexes and g
    generations. CMA-ES makes at most the calls of its settings.
    """
    stage, n = study.imp, len(study.imp.estimate)
    sceua = sceua_calls(stage)
    for cost, terms in stage.costs.items():
        yield f"SCE-UA, {cost}", stage.repetitions * sceua, terms
        for key, optimiser in OPTIMISERS.items():
            yield f"{optimiser.words}, {cost}", optimiser_calls(stage, key), terms
        yield f"good sets, {cost}", float(WALKERS * SWEEPS), terms
    yield "determined parameters", float(ANALYSIS * (2 * n + 1)), stage.channels


def _seconds(study: Study, terms: tuple[TermSpec, ...], seconds: Mapping[str, float]) -> float:
    """Return the core seconds of one call."""
    found = externals(study)
    used = {t.experiment for t in terms} & set(found)
    return float(sum(seconds[name] * found[name].program.cores for name in used))


def _sentences(content: Trial, cores: int) -> Iterator[str]:
    for name, one in content.experiments.items():
        version = f" {one.version}" if one.version else ""
        yield f"{name}: one run of {one.executable}{version} takes {one.seconds:.3g} s"
    calls, hours = content.calls, content.core_hours
    total = sum(calls.values())
    yield (
        f"about {total} model calls ({'; '.join(f'{label}: {n}' for label, n in calls.items())}): "
        f"{in_words(3600.0 * hours)} on one core, {in_words(3600.0 * hours / cores)} on {cores}"
    )
