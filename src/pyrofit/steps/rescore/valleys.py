"""Of every cost the best stored set and its valley."""

import numpy as np
import pandas as pd

from pyrofit.analysis import rescoring
from pyrofit.config import Study
from pyrofit.estimate.measures import Measure
from pyrofit.estimate.prior import within_known
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.scorer import Scorer
from pyrofit.steps.rescore.record import OfMeasure, OfRange


def valleys(
    study: Study, scorer: Scorer, sets: pd.DataFrame, scores: pd.DataFrame
) -> list[OfMeasure]:
    """Return the costs, each with its best set and its valley.

    Parameters
    ----------
    study, scorer
        The study and its costs.
    sets
        The scored sets.
    scores
        Value of each cost for each of them.
    """
    searched = within_known(study, scorer.problem)
    values = sets[list(searched.names)].to_numpy(float)
    fractions = (values - searched.lower) / searched.span
    telling = rescoring.telling(scores)
    return [
        _valley(
            study,
            measure,
            measure.name in telling,
            scores[measure.name].to_numpy(),
            sets,
            fractions,
            searched.names,
        )
        for measure in scorer.measures
    ]


def same_order(scores: pd.DataFrame) -> list[list[str]]:
    """Return groups of costs that rank the sets alike."""
    ranks = rescoring.spearman(scores[rescoring.telling(scores)])
    return [group for group in rescoring.grouped(ranks, rescoring.SAME) if len(group) > 1]


def _valley(
    study: Study,
    measure: Measure,
    tells_apart: bool,
    scores: FloatArray,
    sets: pd.DataFrame,
    fractions: FloatArray,
    names: tuple[str, ...],
) -> OfMeasure:
    found = rescoring.valley(scores, fractions)
    best = sets.iloc[found.best]
    signals = {(t.experiment, t.signal) for t in measure.terms or study.imp.channels}
    ranges = np.column_stack([found.low, found.high, fractions[found.best]]).tolist()
    return OfMeasure(
        name=measure.name,
        words=measure.words,
        signals=[f"{experiment} {signal}" for experiment, signal in sorted(signals)],
        tells_apart=tells_apart,
        value=found.value,
        set_number=int(best["set"]),
        fitted_with=str(best["cost_function"]),
        parameters={name: float(best[name]) for name in names},
        valley_sets=found.sets,
        valley={
            name: OfRange(low=low, high=high, best=at)
            for name, (low, high, at) in zip(names, ranges, strict=True)
        },
    )
