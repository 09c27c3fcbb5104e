"""Fits of a cost function of a study, with one of its optimisers."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.api.choices import complete, in_units
from pyrofit.api.comparison import compared
from pyrofit.api.fit_tables import derived_table, table_in_units
from pyrofit.api.fitted import Fit
from pyrofit.api.measurements import Data, measured
from pyrofit.config import Study
from pyrofit.errors import StudyError, suggest
from pyrofit.estimate.history import best_of
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.estimate.pose import of_diagnosis, pose
from pyrofit.estimate.posterior import limit_of
from pyrofit.estimate.problem import Problem
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray

SCEUA = "sceua"


def check_cost(study: Study, cost: str, optimiser: str) -> None:
    """Refuse a cost function or an optimiser that there is not.

    Raises
    ------
    StudyError
        With the nearest name.
    """
    for argument, name in (("cost", cost), ("optimiser", optimiser)):
        if not isinstance(name, str):
            raise StudyError(
                f"{argument}: a name is needed, and this is a {type(name).__name__}. "
                f"Known costs of the study: {', '.join(study.imp.costs)}"
            )
    if cost not in study.imp.costs:
        known = suggest(cost, study.imp.costs)
        raise StudyError(f"study '{study.name}' has no cost '{cost}'. {known}")
    if optimiser not in (optimisers := [SCEUA, *OPTIMISERS]):
        raise StudyError(f"unknown optimiser '{optimiser}'. {suggest(optimiser, optimisers)}")


def fit_cost(
    study: Study, data: Data | None, cost: str, optimiser: str, given: Mapping[str, float]
) -> Fit:
    """Return the parameters of the lowest cost that an optimiser finds; values in SI units."""
    specs = study.imp.costs[cost]
    keys = list(dict.fromkeys((spec.experiment, spec.signal) for spec in specs))
    series = measured(study, keys, data)
    experiments = {name for name, _ in keys}
    estimate = tuple(name for name in study.imp.estimate if name not in given)
    if not estimate:
        raise StudyError(f"all parameters of the cost '{cost}' are fixed; leave one out of `fixed`")
    fixed = complete(study, given, experiments, but=estimate)
    problem = pose(study, of_diagnosis(study, specs, estimate), series, fixed)
    lowest, x, history = _searched(study, problem, cost, optimiser)
    words = "SCE-UA" if optimiser == SCEUA else OPTIMISERS[optimiser].title
    scored = compared(study, problem.values(x), series)
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
    study: Study, problem: Problem, cost: str, optimiser: str
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
    rows: list[dict[str, Any]] = [
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
