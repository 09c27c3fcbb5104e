"""Which costs rank the stored sets alike, in sentences."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from pyrofit.analysis import rescoring
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.text import listed, several, span
from pyrofit.steps.rescore import record
from pyrofit.steps.rescore.facts import correlation_of_shown, of_shown, shown_by_rank
from pyrofit.steps.rescore.record import OfMeasure, Rescored

DRIFT = 1e-3
"""Relative difference of stored and recomputed costs that is mentioned.

A run that is asked for more signals takes other steps, within a part of the solver's error.
"""
UNDECIDED = 0.05
"""Share of the sets from which on a cost with so many best ones is said not to choose."""
MOST_APART = 3
"""Valleys apart that are named."""


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on how the costs rank the stored sets."""
    found = record.read(study, results)
    better = of_shown(found, record.matrix(results, record.BETTER))
    higher = record.matrix(results, record.EXCESS)
    return [
        _sample(found),
        *alike_costs(correlation_of_shown(study, results)),
        *_among_best(_part(record.matrix(results, record.AMONG_BEST), list(study.imp.costs))),
        *_undecided(found),
        *own_costs(_part(higher, list(study.imp.costs))),
        *regret_of(_part(better, [name for name in better if name not in undecided(found)])),
        *_valleys(shown_by_rank(found), found),
        *_same(found),
        *_warnings(found),
    ]


def _sample(found: Rescored) -> str:
    return (
        f"{found.sampled - found.unfinished} of {found.stored} stored model calls from "
        f"{found.histories} searches were scored under "
        f"{several(len(found.measures), 'cost')}."
    )


def _same(found: Rescored) -> list[str]:
    said = [f"{listed(group)} rank all sets in the same order." for group in found.same]
    mute = [m.name for m in found.measures if not m.tells_apart]
    return said + ([f"{listed(mute)}: the same value for all sets."] if mute else [])


def alike_costs(matrix: pd.DataFrame) -> list[str]:
    """Say which costs rank the sets alike, which do not, and which two agree least."""
    if len(matrix) < 2:
        return []
    groups = rescoring.grouped(matrix, rescoring.ALIKE)
    together = [listed(group) for group in groups if len(group) > 1]
    alone = [group[0] for group in groups if len(group) == 1]
    said = []
    if together:
        said.append(
            f"The sets are ranked alike (rank correlation {rescoring.ALIKE:g} or more) by "
            f"{'; by '.join(together)}."
        )
    if alone:
        others = "any other" if together else "each other"
        verb = "ranks" if len(alone) == 1 else "rank"
        said.append(f"{listed(alone)} {verb} them unlike {others}.")
    one, other, value = rescoring.least_alike(matrix)
    least = f"{value:.2f}".replace("-", "−")
    return [*said, f"{one} and {other} agree least (rank correlation {least})."]


def _among_best(matrix: pd.DataFrame) -> list[str]:
    """Say how far the study's own cost functions agree on good sets."""
    if len(matrix) < 2:
        return []
    beside = matrix.to_numpy()[~np.eye(len(matrix), dtype=bool)]
    low, high = (f"{value:.2f}".replace("-", "−") for value in (beside.min(), beside.max()))
    return [
        f"Over the best {100.0 * rescoring.GOOD:g} % of the sets of one of them, the rank "
        f"correlation of two cost functions of the study is {low} to {high}."
    ]


def undecided(found: Rescored) -> dict[str, float]:
    """Return the costs with very many best sets that tie, and the share of these [%]."""
    scored = found.sampled - found.unfinished
    parts = {m.name: m.valley_sets / scored for m in shown_by_rank(found) if m.tells_apart}
    return {name: 100.0 * part for name, part in parts.items() if part > UNDECIDED}


def _undecided(found: Rescored) -> list[str]:
    return [
        f"{name} has its lowest value for {share:.0f} % of the sets and does not rank these."
        for name, share in undecided(found).items()
    ]


def _part(table: pd.DataFrame, names: Sequence[object]) -> pd.DataFrame:
    """Return the part of a square table that belongs to some costs."""
    known = [name for name in names if name in table]
    return table.loc[known, known]


def own_costs(higher: pd.DataFrame) -> list[str]:
    """Say how far the study's own cost functions regret each other's best sets."""
    if len(higher) < 2 or higher.isna().all(axis=None):
        return []
    row = str(higher.max(axis=1).idxmax())
    column = str(higher.T[row].idxmax())
    most = 100.0 * float(higher.T[row].max())
    return [
        f"The set with the lowest {row} is {span([most])} % above the lowest {column}, the largest "
        "excess among the cost functions of the study."
    ]


def regret_of(better: pd.DataFrame) -> list[str]:
    """Say which best set is worst under another cost."""
    if len(better) < 2 or better.max(axis=None) == 0.0:
        return []
    row = str(better.max(axis=1).idxmax())
    column = str(better.T[row].idxmax())
    share = 100.0 * float(better.T[row].max())
    return [
        f"The largest disagreement: {column} finds {share:.2g} % of the sets better than the set "
        f"with the lowest {row}."
    ]


def _valleys(measures: Sequence[OfMeasure], found: Rescored) -> list[str]:
    """Say in which parameters valleys lie apart, the farthest pair of each."""
    best = f"the best {100.0 * found.valley_share:g} % of the sets"
    apart = sorted(_farthest(measures, name) for name in measures[0].valley)
    apart = [(size, words) for size, words in apart if size < 0.0]
    if not apart:
        return [f"The valleys of all costs ({best}) overlap in every parameter."]
    named = [f"{words} ({-100.0 * size:.2g} %)" for size, words in apart[:MOST_APART]]
    return [
        f"Some valleys ({best}) lie apart in {several(len(apart), 'parameter')}; farthest, in per "
        f"cent of the search range: {listed(named)}."
    ]


def _farthest(measures: Sequence[OfMeasure], name: str) -> tuple[float, str]:
    """Return the largest distance of two valleys in a parameter, negative, and whose it is."""
    found = (0.0, "")
    for i, one in enumerate(measures):
        for other in measures[:i]:
            here, there = one.valley[name], other.valley[name]
            size = rescoring.gap((here.low, here.high), (there.low, there.high))
            found = min(found, (-size, f"{other.name} and {one.name} in {name}"))
    return found


def _warnings(found: Rescored) -> list[str]:
    said = []
    if found.unfinished:
        said.append(f"{several(found.unfinished, 'run')} did not finish and are left out.")
    if found.drift > DRIFT:
        said.append(
            f"Stored and recomputed costs differ by up to {100.0 * found.drift:.2g} %: program or "
            "packages have changed since the searches."
        )
    return said + [f"Left out: {reason}" for reason in found.left_out]
