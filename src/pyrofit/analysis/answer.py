"""The answer of a study: one value of every parameter, used wherever one set is needed.

The values are the estimates of the step identify. They maximise the likelihood, which weighs each
point by its noise and holds the known values. Where the model misses its tests, they are those of
least squares. The kinetics are estimated first. The inverse modelling takes them as given, and
has the last word on a parameter that both estimate.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from pyrofit.analysis.estimates import Estimated
from pyrofit.config import Study
from pyrofit.results import identification, kinetics
from pyrofit.results.files import Results


def answer_values(study: Study, results: Results) -> dict[str, float]:
    """Return the answer: the values of all parameters, given ones included, SI units.

    Raises
    ------
    DataError
        A result of the step identify is missing or broken.
    """
    found = identification.estimates(study, results)["estimate"]
    return kinetics.fixed_for_imp(study, results) | {str(n): float(v) for n, v in found.items()}


def one_each(study: Study, estimates: Sequence[Estimated]) -> list[Estimated]:
    """Return the estimates of the answer: one for each parameter, in their order."""
    again = estimated_twice(study)
    return [e for e in estimates if e.stage == "imp" or e.name not in again]


def estimated_twice(study: Study) -> list[str]:
    """Return the parameters that the kinetics and the inverse modelling both estimate."""
    first = study.kinetics.estimate if study.kinetics else ()
    return [name for name in first if name in study.imp.estimate]


@dataclass(frozen=True)
class OutsideAnswer:
    """The best set of a cost function, and which of its values leave the answer's intervals.

    Parameters
    ----------
    cost_function, found_by
        The cost function, and the optimiser that found its set.
    values
        Estimate and the set's value of each such parameter, in its unit.
    """

    cost_function: str
    found_by: str
    values: tuple[tuple[Estimated, float], ...]


def outside_intervals(
    study: Study, estimates: Sequence[Estimated], best: pd.DataFrame
) -> list[OutsideAnswer]:
    """Return which best sets have values outside the 95 % intervals of the answer, and where.

    Parameters
    ----------
    study
        The study.
    estimates
        The estimates.
    best
        The best set of each cost function, SI units; see `pyrofit.analysis.best_sets.best_sets`.
    """
    ours = [e for e in one_each(study, estimates) if e.stage == "imp"]
    return [
        OutsideAnswer(
            str(row["cost_function"]), str(row["found_by"]), tuple(_outside(study, ours, row))
        )
        for row in best.to_dict("records")
    ]


def _outside(
    study: Study, estimates: Sequence[Estimated], values: Mapping[object, object]
) -> list[tuple[Estimated, float]]:
    found = [(e, float(str(values[e.name])) / study.parameters[e.name].factor) for e in estimates]
    return [(e, value) for e, value in found if not e.low <= value <= e.high]
