"""The diagnosis of a study, from its measurements to what is said of it."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.diagnose.advise.free_corrections import Probe, probes
from pyrofit.diagnose.advise.separation import next_experiments
from pyrofit.diagnose.base.fit import set_up
from pyrofit.diagnose.base.fitted import FittedModel, up_to_date
from pyrofit.diagnose.judge.findings import Verdict
from pyrofit.diagnose.judge.profiles import profiles
from pyrofit.diagnose.judge.verdict import judge
from pyrofit.diagnose.result import record
from pyrofit.diagnose.search.step import SearchContext, Tell, in_order
from pyrofit.diagnose.search.stepwise import Search, search
from pyrofit.estimate.targets import Measurements


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """A search, the verdict on it, and both as tidy results."""

    search: Search
    verdict: Verdict
    content: dict[str, Any]
    curves: pd.DataFrame


def examine(
    study: Study,
    measurements: Measurements,
    tell: Tell = lambda text: None,
    processes: int = 1,
    advise: bool = True,
) -> Diagnosis:
    """Find where a study's model and measurements disagree, and which effect the model lacks.

    Parameters
    ----------
    study
        The study; ``diagnosis`` says what is fitted, held out and tried.
    measurements
        Measured series by (experiment, signal), SI units.
    tell
        Is told what goes on.
    processes
        Processes that share the fits; the result does not depend on their number.
    advise
        Whether to look for free corrections and the next experiment as well.

    Raises
    ------
    DataError
        A channel is too short, or no run within the limits finishes.
    """
    setup = set_up(study, measurements, processes)
    tell(f"base model: chi-square {setup.base.fit.chi2:.1f} of {setup.base.model.points} points")
    rng = np.random.default_rng(study.seed)
    context = SearchContext(rng, tell, processes, setup.other_starts)
    found = search(setup.base, setup.candidates, study.diagnosis.most_effects, context)
    verdict = judge(found, context.rng, processes)
    found = verdict.search
    content = record.content(study, found, verdict)
    content["profiles"] = profiles(found.end, processes) if advise else []
    content["probes"] = [_shown(p) for p in (_probes(found, verdict, processes) if advise else [])]
    designs = next_experiments(_undecided(found, verdict)) if advise else []
    content["next_experiment"] = [asdict(design) for design in designs]
    tell(content["verdict"]["words"])
    return Diagnosis(found, verdict, content, record.curves(found))


def diagnose(study: Study, measurements: Measurements) -> dict[str, Any]:
    """Return the content of ``diagnosis.json``, without advice."""
    return examine(study, measurements, advise=False).content


def _probes(found: Search, verdict: Verdict, processes: int) -> list[Probe]:
    return probes(found.end, processes) if verdict.kind in ("partly", "unknown") else []


def _shown(probe: Probe) -> dict[str, Any]:
    """Return a probe without its coefficients, which its shape shows."""
    return {key: value for key, value in asdict(probe).items() if key != "coefficients"}


def _undecided(found: Search, verdict: Verdict) -> list[FittedModel]:
    """Return the models that are not told apart, or else the two best of different effects."""
    for finding in verdict.findings:
        if len(finding.kept) > 1:
            return [judged.trial for judged in finding.kept]
    best: dict[frozenset[str], FittedModel] = {}
    for trial in in_order(found.trials):
        best.setdefault(frozenset(trial.effects), trial)
    return [up_to_date(trial) for trial in list(best.values())[:2]]
