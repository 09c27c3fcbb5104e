"""The diagnosis of a study, from its measurements to what is said of it."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.diagnose import record
from pyrofit.diagnose.design import next_experiments
from pyrofit.diagnose.probes import probes
from pyrofit.diagnose.search import Search, search
from pyrofit.diagnose.setup import set_up
from pyrofit.diagnose.verdict import Verdict, judge
from pyrofit.estimate.problem import Measurements


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
    tell: Callable[[str], None] = lambda text: None,
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
    advise
        Whether to look for free corrections and the next experiment as well.

    Raises
    ------
    DataError
        A channel is too short, or no run within the limits finishes.
    """
    setup = set_up(study, measurements)
    tell(f"base model: chi-square {setup.base.fit.chi2:.1f} of {setup.base.model.points} points")
    rng = np.random.default_rng(study.seed)
    found = search(setup.base, setup.candidates, study.diagnosis.most_effects, rng, tell)
    verdict = judge(found, rng)
    content = record.content(study, found, verdict)
    content["probes"] = [asdict(p) for p in (_probes(found, verdict) if advise else [])]
    designs = _designs(found, verdict) if advise else []
    content["next_experiment"] = [asdict(design) for design in designs]
    tell(content["verdict"]["words"])
    return Diagnosis(found, verdict, content, record.curves(found))


def diagnose(study: Study, measurements: Measurements) -> dict[str, Any]:
    """Return the content of ``diagnosis.json``, without advice."""
    return examine(study, measurements, advise=False).content


def _probes(found: Search, verdict: Verdict) -> list[Any]:
    return list(probes(found.end)) if verdict.kind == "unknown" else []


def _designs(found: Search, verdict: Verdict) -> list[Any]:
    """Return the experiments that would tell apart what this one does not."""
    for finding in verdict.findings:
        if len(finding.kept) > 1:
            return list(next_experiments([judged.trial for judged in finding.kept[:3]]))
    best = sorted(found.rounds[0].trials, key=lambda trial: trial.penalised)[:2]
    return list(next_experiments(best)) if len(best) == 2 else []
