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
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
import pandas as pd
from which_cost_cases import FAST, PLANS, SIGNALS, Case, Posed, cases_of, posed
from which_cost_costs import COSTS, LIKELIHOODS, Fitted, fitted
from which_cost_report import report

from pyrofit.config import TermSpec
from pyrofit.errors import DataError
from pyrofit.estimate import cmaes
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.history import best_of
from pyrofit.estimate.identify import identify
from pyrofit.estimate.least_squares import Start, descend, multistart
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.problem import make_problem
from pyrofit.estimate.sceua import search_several
from pyrofit.results.files import write_csv
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray

SEARCHED = ("RMSE", "RANGE", "BANDS", "chi2", "chi2_all")
"""Costs that SCE-UA minimises as well."""
GENERATIONS = 12
CALLS = 1500
"""Calls of a search by SCE-UA are about this many; CMA-ES is given as many."""
STARTS = {"least squares": 3, "CMA-ES": 1}


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
    for case in cases_of(given.plan):
        if given.report or _path(given.folder, "ends", case).exists():
            continue
        try:
            run(case, given.folder)
        except DataError as error:
            print(f"{case.id} is left out: {error}", flush=True)
    report(given.folder)


if __name__ == "__main__":
    main()
