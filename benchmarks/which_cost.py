"""Fit twins and measured data with every cost, and tell which estimates and predicts best.

    python benchmarks/which_cost.py FOLDER --plan full            # the page of docs/which_cost.md
    python benchmarks/which_cost.py FOLDER --plan short           # a few cases
    python benchmarks/which_cost.py FOLDER --plan full --report   # tables and figures alone

Each case writes two files below FOLDER, and a case that has them is not run again.
"""

import argparse
import os
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
import pandas as pd
from which_cost_cases import FAST, PLANS, SIGNALS, Case, Posed, cases_of, posed
from which_cost_report import report

from pyrofit.config import TermSpec
from pyrofit.cost import WeightedSum
from pyrofit.cost.term import Term
from pyrofit.estimate import cmaes
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.history import best_of
from pyrofit.estimate.identify import identify
from pyrofit.estimate.least_squares import Start, descend, multistart
from pyrofit.estimate.likelihood import Likelihood, likelihood_of
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.prior import within_known
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.estimate.sceua import search_several
from pyrofit.results.files import write_csv
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.rescore_measures import measures_of

SUMS: dict[str, tuple[str, ...]] = {
    "THR": ("THR_above", "THR_below"),
    "NRSE+THR": ("NRSE", "THR_above", "THR_below"),
    "RMSE+NRSE+THR": ("RMSE_mean", "NRSE", "THR_above", "THR_below"),
}
"""Eq. 5 with all weights 1."""
OF_RATE: dict[str, tuple[str, ...]] = {
    "RMSE": ("RMSE_mean",),
    "RANGE": ("RANGE_printed",),
    "RANGE_PROPTI": ("RANGE_PROPTI",),
    "BANDS": ("BANDS_printed",),
    "BANDS_PROPTI": ("BANDS_PROPTI",),
    "GPYRO": ("GPYRO",),
    "NRSE": ("NRSE",),
    **SUMS,
}
"""Costs of the rate alone, by the names of `pyrofit rescore` that they are made of."""
OF_BOTH: dict[str, tuple[str, ...]] = {"NRMS_all": ("NRMS_all",), "GPYRO_all": ("GPYRO_all",)}
"""Costs of rate and back temperature."""
LIKELIHOODS = {"chi2": SIGNALS[:1], "chi2_all": SIGNALS}
COSTS = (*OF_RATE, "chi2", *OF_BOTH, "chi2_all")
SEARCHED = ("RMSE", "RANGE", "BANDS", "chi2", "chi2_all")
"""Costs that SCE-UA minimises as well."""
GENERATIONS = 12
CALLS = 1500
"""Calls of a search by SCE-UA are about this many; CMA-ES is given as many."""
STARTS = {"least squares": 3, "CMA-ES": 1}
CLOSE = 0.01
"""A search has found the least cost if it ends above it by less than this share; a sum of squares
by twice that, a cost that can be zero by 1e-4."""


class SumOfSquares(WeightedSum):
    """The sum of the squares of the costs: chi-square where residuals are whitened."""

    def parts(self, models: Sequence[FloatArray]) -> list[float]:
        """Give the squares."""
        return [part**2 for part in super().parts(models)]


@dataclass(frozen=True)
class Fitted:
    """A cost on a case.

    Parameters
    ----------
    name
        Name of the cost.
    problem
        What optimisers minimise.
    likelihood
        The likelihood whose intervals belong to it, if there is one.
    """

    name: str
    problem: Problem
    likelihood: Likelihood | None = None

    @property
    def close(self) -> float:
        """How far above the least value a search may end."""
        return CLOSE * (2.0 if isinstance(self.problem.cost, SumOfSquares) else 1.0)


def fitted(of: Posed, name: str, accuracy: dict[str, Any]) -> Fitted:
    """Return a cost as optimisers search it."""
    study, series = of.study, of.series
    if name in LIKELIHOODS:
        terms = [TermSpec(experiment=of.fitted, signal=s, kind="RMSE") for s in LIKELIHOODS[name]]
    else:
        names = {**OF_RATE, **OF_BOTH}[name]
        terms = [t for m in measures_of(study, series, names)[0] for t in m.terms]
    material = study.material_with(study.imp.kinetics)
    made = make_problem(study, study.imp.estimate, terms, series, material, of.fixed)
    problem = replace(
        within_known(study, made), accuracy=study.accuracy.model_copy(update=accuracy)
    )
    if name not in LIKELIHOODS:
        return Fitted(name, problem)
    likelihood = likelihood_of(problem)
    return Fitted(name, replace(problem, cost=_chi2(likelihood)), likelihood)


def _chi2(likelihood: Likelihood) -> SumOfSquares:
    """Return chi-square as a cost."""
    terms = []
    for noise, (_, term) in zip(likelihood.noise, likelihood.problem.cost.terms, strict=True):
        residuals = partial(_whitened, noise, term.target.value)
        terms.append((1.0, Term("chi2", term.target, {}, residuals)))
    return SumOfSquares(terms)


def _whitened(noise: NoiseModel, value: FloatArray, model: FloatArray) -> FloatArray:
    return noise.whiten(model - value)


def predicted(of: Posed, X: FloatArray) -> pd.DataFrame:
    """Return rms differences from the compared curves over their range, by signal and set."""
    study = of.study
    terms = [
        TermSpec(experiment=e, signal=s, kind="RMSE", normalisation="range")
        for e in (of.fitted, of.unseen)
        for s in SIGNALS
    ]
    material = study.material_with(study.imp.kinetics)
    problem = make_problem(study, study.imp.estimate, terms, of.compared, material, of.fixed)
    columns = [f"{kind}_{s}" for kind in ("fitted", "unseen") for s in SIGNALS]
    return pd.DataFrame([e.parts for e in problem.evaluate_all(X)], columns=columns)


def searched(cost: Fitted, case: Case) -> Iterator[tuple[str, Start, list[float]]]:
    """Yield optimiser, end, and the running least cost by call (SCE-UA) of every search."""
    seed = seed_for(1, case.id, cost.name)
    ends = []
    for start in multistart(cost.problem, STARTS["least squares"], seed):
        ends.append(start)
        yield "least squares", start, []
    for start in cmaes.minimise(cost.problem, STARTS["CMA-ES"], seed, CALLS):
        ends.append(start)
        yield "CMA-ES", start, []
    if case.repetitions and cost.name in SEARCHED:
        seeds = [seed_for(seed, k) for k in range(case.repetitions)]
        for history in search_several(cost.problem, seeds, GENERATIONS):
            lowest, x = best_of(history, cost.problem)
            ends.append(Start(lowest, x, len(history), ()))
            yield "SCE-UA", ends[-1], history["cost"].cummin().tolist()
    best = min(ends, key=lambda end: end.cost)
    polished = descend(cost.problem, best.values)
    yield "best", polished if polished.cost < best.cost else best, []


def ends_of(of: Posed, cost: Fitted, case: Case) -> pd.DataFrame:
    """Return a row for every search of a cost, errors in fractions of limits and ranges."""
    found = list(searched(cost, case))
    least = min(start.cost for _, start, _ in found)
    limit = max(least * (1.0 + cost.close), least + 1e-4)
    X = np.array([start.values for _, start, _ in found])
    rows = [
        {
            "cost": cost.name,
            "optimiser": optimiser,
            "value": start.cost,
            "calls": start.calls,
            "found": start.cost <= limit,
            "calls_to_it": 1 + int(np.sum(np.array(running) > limit)) if running else start.calls,
        }
        for optimiser, start, running in found
    ]
    errors = X if of.truth is None else X - of.truth
    errors = errors / cost.problem.span
    names = [f"x_{name}" for name in cost.problem.names]
    return pd.concat(
        [pd.DataFrame(rows), pd.DataFrame(errors, columns=names), predicted(of, X)], axis=1
    )


def intervals_of(of: Posed, cost: Fitted, x: FloatArray) -> list[dict[str, object]]:
    """Return 95 % intervals about the best set, ends as fractions of the limits less the truth.

    RMSE has those of white noise as large as its residuals; the likelihood has its own.
    """
    likelihood = cost.likelihood or _white(cost, x)
    assert of.truth is not None
    truth = likelihood.scaled(of.truth)
    found = identify(likelihood, [likelihood.scaled(x)])
    return [
        {
            "cost": cost.name,
            "parameter": e.name,
            "low": e.interval.low - at,
            "high": e.interval.high - at,
            "verdict": e.verdict,
        }
        for e, at in zip(found.estimates, truth.tolist(), strict=True)
    ]


def _white(cost: Fitted, x: FloatArray) -> Likelihood:
    """Return the likelihood of white noise as large as the residuals at x."""
    _, (model,) = cost.problem.simulate(x)
    value = cost.problem.cost.terms[0][1].target.value
    size = float(np.sqrt(np.mean((model - value) ** 2)))
    return Likelihood(cost.problem, (NoiseModel(np.full(value.size, size), Correlation()),))


def run(case: Case, folder: Path, costs: Sequence[str] = COSTS) -> None:
    """Run a case and write its two files."""
    begun = time.process_time()
    of = posed(case, folder)
    accuracy = FAST if of.fitted == "capa_25" else {}
    about = {"kind": case.kind, "name": case.name, "number": case.number}
    ends, intervals = [], []
    for name in costs:
        started = time.process_time()
        cost = fitted(of, name, accuracy)
        found = ends_of(of, cost, case)
        ends.append(found.assign(seconds=time.process_time() - started))
        if of.truth is not None and name in ("RMSE", *LIKELIHOODS):
            best = found[found["optimiser"] == "best"].iloc[0]
            x = np.array([best[f"x_{n}"] for n in cost.problem.names])
            intervals += intervals_of(of, cost, x * cost.problem.span + of.truth)
    write_csv(_path(folder, "intervals", case), pd.DataFrame(intervals).assign(**about))
    write_csv(_path(folder, "ends", case), pd.concat(ends, ignore_index=True).assign(**about))
    print(f"{case.id}: {time.process_time() - begun:.1f} s of processor time", flush=True)


def _path(folder: Path, kind: str, case: Case) -> Path:
    return folder / kind / f"{case.id}.csv"


def main() -> None:
    """Run the cases that have no files yet, then write tables and figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--plan", choices=PLANS, default="short")
    parser.add_argument("--report", action="store_true", help="run nothing")
    given = parser.parse_args()
    cases = list(cases_of(given.plan))
    for case in cases:
        if not given.report and not _path(given.folder, "ends", case).exists():
            run(case, given.folder)
    report(given.folder)


if __name__ == "__main__":
    main()
