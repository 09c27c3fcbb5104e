"""Fits of a cost function of a study, with one of its optimisers."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from pyrofit.api.choices import Key, complete, in_units
from pyrofit.api.comparison import series_compared
from pyrofit.api.fit_tables import derived_table, table_in_units
from pyrofit.api.fitted import Fit
from pyrofit.api.measurements import Data, read_to_fit
from pyrofit.api.own_cost import OwnCost, own_term
from pyrofit.api.tasks import Task, begin_of, initial_of
from pyrofit.config import Study
from pyrofit.cost import WeightedSum
from pyrofit.errors import StudyError, suggest
from pyrofit.estimate.history import best_of
from pyrofit.estimate.least_squares import descend
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.estimate.pose import of_diagnosis, pose
from pyrofit.estimate.posterior import limit_of
from pyrofit.estimate.problem import Problem
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray

SCEUA = "sceua"


def check_cost(study: Study, cost: str) -> None:
    """Refuse a cost function that the study has not.

    Raises
    ------
    StudyError
        With the nearest name.
    """
    if not isinstance(cost, str):
        raise StudyError(
            "cost: the name of a cost or a function is needed, and this is a "
            f"{type(cost).__name__}. Known costs of the study: {', '.join(study.imp.costs)}"
        )
    if cost not in study.imp.costs:
        known = suggest(cost, study.imp.costs)
        raise StudyError(f"study '{study.name}' has no cost '{cost}'. {known}")


def check_optimiser(study: Study, optimiser: str, initial: Mapping[str, float] | None) -> None:
    """Refuse an optimiser that there is not, and initial values of one that takes none.

    Raises
    ------
    StudyError
        With the nearest name.
    """
    known = [SCEUA, *OPTIMISERS]
    if optimiser not in known:
        raise StudyError(f"unknown optimiser '{optimiser}'. {suggest(str(optimiser), known)}")
    if initial is not None and optimiser != "least_squares":
        raise StudyError(
            f"initial: {optimiser} draws its own starts; leave it out, or use least_squares"
        )


def fit_cost(
    study: Study,
    data: Data | None,
    cost: str,
    optimiser: str,
    given: Mapping[str, float],
    initial: Mapping[str, float] | None = None,
) -> Fit:
    """Return the parameters of the lowest cost that an optimiser finds; ``given`` in SI units."""
    specs = study.imp.costs[cost]
    keys = list(dict.fromkeys((spec.experiment, spec.signal) for spec in specs))
    series = read_to_fit(study, keys, data)
    experiments = {name for name, _ in keys}
    estimate = tuple(name for name in study.imp.estimate if name not in given)
    if not estimate:
        raise StudyError(f"all parameters of the cost '{cost}' are fixed; leave one out of `fixed`")
    fixed = complete(study, given, experiments, but=estimate)
    problem = pose(study, of_diagnosis(study, specs, estimate), series, fixed)
    return _fitted(study, problem, series, cost, optimiser, initial)


def fit_own_cost(
    task: Task,
    data: Data | None,
    cost: OwnCost,
    optimiser: str,
    initial: Mapping[str, float] | None,
) -> Fit:
    """Return the parameters of the lowest value of a caller's function.

    Raises
    ------
    StudyError
        It returns neither residuals nor a cost.
    """
    series = read_to_fit(task.study, task.keys, data)
    asked = of_diagnosis(task.study, task.channels, task.estimate)
    problem = pose(task.study, asked, series, task.fixed)
    name = getattr(cost, "__name__", type(cost).__name__)
    terms = [(weight, own_term(cost, name, term)) for weight, term in problem.cost.terms]
    problem = replace(problem, cost=WeightedSum(terms))
    return _fitted(task.study, problem, series, name, optimiser, initial)


def _fitted(
    study: Study,
    problem: Problem,
    series: Mapping[Key, pd.DataFrame],
    cost: str,
    optimiser: str,
    initial: Mapping[str, float] | None,
) -> Fit:
    """Return the fit of the lowest cost of a problem."""
    begin = initial_of(study, problem.names, initial)
    lowest, x, history = _searched(study, problem, cost, optimiser, begin)
    words = "SCE-UA" if optimiser == SCEUA else OPTIMISERS[optimiser].title
    scored = series_compared(study, problem.values(x), series)
    own = {n: v for n, v in problem.values(x).items() if n in study.parameters}
    values = in_units(study, own)
    return Fit(
        study=study,
        method=f"cost {cost}, {words}",
        values=values,
        table=_table(study, problem, x),
        comparison=scored,
        signals=scored.scores,
        cost=lowest,
        history=table_in_units(study, history),
        derived=derived_table(study, values, None),
    )


def _searched(
    study: Study, problem: Problem, cost: str, optimiser: str, initial: Mapping[str, float]
) -> tuple[float, FloatArray, pd.DataFrame]:
    """Return the lowest cost, its set, and the calls or the ends of all starts."""
    if optimiser == SCEUA:
        from pyrofit.estimate.sceua import search  # SPOTPY sets up a logger of its own for all

        budget = study.imp.sceua
        history = search(
            problem, seed_for(study.seed, cost, 0), budget.generations, budget.complexes, None
        )
        return *best_of(history, problem), history
    seed = seed_for(study.seed, cost, optimiser)
    ends = OPTIMISERS[optimiser].run(problem, getattr(study.imp, optimiser), seed)
    if initial:
        first = descend(problem, begin_of(problem, initial))
        ends = sorted([first, *ends], key=lambda end: end.cost)
    rows: list[dict[str, object]] = [
        {
            "cost": end.cost,
            "calls": end.calls,
            **dict(zip(problem.names, end.values.tolist(), strict=True)),
        }
        for end in ends
    ]
    return ends[0].cost, ends[0].values, pd.DataFrame(rows)


def _table(study: Study, problem: Problem, x: FloatArray) -> pd.DataFrame:
    rows = []
    for i, name in enumerate(problem.names):
        factor = study.parameters[name].factor
        rows.append(
            {
                "parameter": name,
                "value": x[i] / factor,
                "sd": np.nan,
                "low": np.nan,
                "high": np.nan,
                "unit": study.parameters[name].unit,
                "lower": problem.lower[i] / factor,
                "upper": problem.upper[i] / factor,
                "at_limit": limit_of(float((x[i] - problem.lower[i]) / problem.span[i])),
                "verdict": "",
                "method": "",
            }
        )
    return pd.DataFrame(rows).set_index("parameter")
