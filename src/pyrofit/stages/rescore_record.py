"""The record of stored sets that were scored again: every cost, its best set and its valley."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis import rescoring
from pyrofit.config import Study
from pyrofit.estimate.measures import Measure
from pyrofit.estimate.prior import within_known
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.scorer import Scorer


def content_of(
    about: Mapping[str, Any], study: Study, scorer: Scorer, sets: pd.DataFrame, scores: pd.DataFrame
) -> dict[str, Any]:
    """Return the record, see `pyrofit.results.rescored`.

    Parameters
    ----------
    about
        Facts about the sample.
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
    alike = rescoring.grouped(rescoring.spearman(scores[telling]), rescoring.SAME)
    return {
        **about,
        "valley_share": rescoring.VALLEY,
        "same": [group for group in alike if len(group) > 1],
        "measures": [
            {
                **_described(study, measure),
                "tells_apart": measure.name in telling,
                **_found(scores[measure.name].to_numpy(), sets, fractions, searched.names),
            }
            for measure in scorer.measures
        ],
    }


def _described(study: Study, measure: Measure) -> dict[str, Any]:
    signals = {(t.experiment, t.signal) for t in measure.terms or study.imp.channels}
    return {
        "name": measure.name,
        "words": measure.words,
        "signals": [f"{experiment} {signal}" for experiment, signal in sorted(signals)],
    }


def _found(
    scores: FloatArray, sets: pd.DataFrame, fractions: FloatArray, names: tuple[str, ...]
) -> dict[str, Any]:
    """Return the best set of a cost and its valley."""
    valley = rescoring.valley(scores, fractions)
    best = sets.iloc[valley.best]
    ranges = np.column_stack([valley.low, valley.high, fractions[valley.best]])
    return {
        "value": valley.value,
        "set_number": int(best["set"]),
        "fitted_with": str(best["cost_function"]),
        "parameters": {name: float(best[name]) for name in names},
        "valley_sets": valley.sets,
        "valley": {
            name: dict(zip(("low", "high", "best"), row, strict=True))
            for name, row in zip(names, ranges.tolist(), strict=True)
        },
    }
