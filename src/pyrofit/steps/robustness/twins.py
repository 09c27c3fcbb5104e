"""Errors of the fits to twins of known truth."""

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results import searches
from pyrofit.results.files import Results, read_csv
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.robustness.options import RobustnessOptions

NOISE, OUTLIERS = "noise", "outliers"
"""Disturbances of a twin: stronger noise, or outliers to a share of the points."""
RECOVERED = 20.0
"""Largest root mean square error of a parameter that is recovered [% of its limits]."""


def errors_of_twins(study: Study, results: Results) -> pd.DataFrame:
    """Return the errors of all fitted twins: a row each, parameters in per cent of their limits.

    ``error``: root mean square over the parameters that are `recovered`.
    """
    names = list(study.imp.estimate)
    limits = np.array([study.parameters[name].bounds_si for name in names])
    truth = true_set(study, results)
    columns = {"kind": object, **dict.fromkeys(("level", "draw", "cost", "calls", *names), float)}
    frames = [
        read_csv(
            results.of_step("robustness", f"{cost}.csv"), columns, {("cost_function",): [(cost,)]}
        )
        for cost in study.imp.costs
    ]
    frame = pd.concat(frames, ignore_index=True)
    off = 100.0 * (frame[names].to_numpy(float) - truth) / (limits[:, 1] - limits[:, 0])
    frame[names] = off
    frame["error"] = np.sqrt((frame[recovered(study, frame)] ** 2).mean(axis=1))
    return frame


def recovered(study: Study, errors: pd.DataFrame) -> list[str]:
    """Return the parameters that some cost function recovers at the least noise, else all.

    The data do not determine the others: their errors are those of any value within the limits, and
    tell nothing of the cost functions.
    """
    least = errors[
        (errors["kind"] == NOISE) & (errors["level"] == min(study.options(RobustnessOptions).noise))
    ]
    names = list(study.imp.estimate)
    size = np.sqrt((least[names] ** 2).groupby(least["cost_function"]).mean()).min()
    return [name for name in names if size[name] <= RECOVERED] or names


def true_set(study: Study, results: Results) -> FloatArray:
    """Return the parameters of the twins, SI units.

    The truth of synthetic measurements where there is one, else the mean over all repetitions,
    which lies inside the limits.
    """
    if study.synthetic is not None:
        truth = study.true_values()
        return np.array([truth[name] for name in study.imp.estimate])
    summary = searches.best_of_repetitions(study, results)
    return summary[list(study.imp.estimate)].mean().to_numpy(float)
