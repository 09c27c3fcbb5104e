"""How far estimates are from a known truth."""

from collections.abc import Iterable, Mapping

import pandas as pd

from pyrofit.config import Kinetics, Study, TermSpec
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results import kinetics, searches
from pyrofit.results.files import Results, read_csv
from pyrofit.results.searches import End

KINETICS = "kinetics"
Set = Mapping[str, float] | pd.Series
"""A set of parameters, SI units."""


def fits_to_computed(study: Study) -> list[str]:
    """Return the fits to computed signals alone: 'kinetics' and names of cost functions."""
    stages: dict[str, Iterable[TermSpec]] = dict(study.imp.costs)
    if study.kinetics is not None:
        stages = {KINETICS: study.kinetics.cost, **stages}
    return [
        name
        for name, terms in stages.items()
        if all(study.is_computed(term.experiment, term.signal) for term in terms)
    ]


def truth(study: Study, results: Results) -> pd.DataFrame:
    """Set the true value of every parameter beside the best ones that the optimisers found.

    error_truth = (x - x_true)/x_true, error_limits = (x - x_true)/(x_upper - x_lower).

    Returns
    -------
    pandas.DataFrame
        One row per fit ('kinetics' and each cost function) and parameter, in its own unit; errors
        in per cent, none of a truth that is 0.
    """
    rows = []
    for fit in fits_to_computed(study):
        if fit == KINETICS:
            assert study.kinetics is not None
            estimate, found = study.kinetics.estimate, _kinetics(study, study.kinetics, results)
        else:
            estimate, found = study.imp.estimate, _imp(study, results, fit)
        rows += [
            recovery_row(study, fit, name, {by: float(best[name]) for by, best in found.items()})
            for name in estimate
        ]
    return pd.DataFrame(rows)


def _kinetics(study: Study, stage: Kinetics, results: Results) -> Mapping[str, Set]:
    history = read_csv(
        results.kinetics("history.csv.gz"), dict.fromkeys(("cost", *stage.estimate), float)
    )
    return {
        "sceua": _lowest(history),
        "least_squares": _best(kinetics.read_fit(study, results).least_squares),
    }


def _imp(study: Study, results: Results, cost: str) -> Mapping[str, Set]:
    summary = searches.best_of_repetitions(study, results)
    return {
        "sceua": _lowest(summary[summary["cost_function"] == cost]),
        **{key: _best(searches.read_starts(study, results, cost, key)) for key in OPTIMISERS},
    }


def _lowest(sets: pd.DataFrame) -> pd.Series:
    return sets.iloc[int(sets["cost"].argmin())]


def _best(starts: list[End]) -> dict[str, float]:
    return min(starts, key=lambda start: start.cost).parameters


def recovery_row(
    study: Study, fit: str, name: str, found: Mapping[str, float]
) -> dict[str, object]:
    """Return one row: the truth of a parameter beside its estimates by optimiser, SI units."""
    assert study.synthetic is not None
    parameter = study.parameters[name]
    assert parameter.lower is not None
    assert parameter.upper is not None
    true = study.synthetic.truth[name]
    row: dict[str, object] = {"fit": fit, "parameter": name, "unit": parameter.unit, "truth": true}
    for optimiser, value in found.items():
        estimate = value / parameter.factor
        row[f"{optimiser}_best"] = estimate
        error = 100.0 * (estimate - true)
        row[f"{optimiser}_error_truth_percent"] = error / true if true else None
        row[f"{optimiser}_error_limits_percent"] = error / (parameter.upper - parameter.lower)
    return row
