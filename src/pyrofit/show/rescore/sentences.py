"""Which costs rank the stored sets alike, in sentences."""

from collections.abc import Sequence

import pandas as pd

from pyrofit.analysis import rescoring
from pyrofit.config import Study
from pyrofit.results import rescored
from pyrofit.results.files import Results
from pyrofit.results.rescored import OfMeasure, Rescored
from pyrofit.show.rescore.facts import correlation, of_shown, shown
from pyrofit.show.text import listed, number, several

DRIFT = 1e-6
"""Relative difference of stored and recomputed costs that is mentioned."""
MOST_PAIRS = 3
"""Pairs of valleys apart that are named."""


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on how the costs rank the stored sets."""
    found = rescored.read(study, results)
    return [
        _sample(found),
        *_same(found),
        *_alike(correlation(study, results)),
        *_regret(of_shown(found, rescored.matrix(results, rescored.BETTER))),
        *_valleys(shown(found), found),
        *_warnings(found),
    ]


def _sample(found: Rescored) -> str:
    return (
        f"{found.sampled - found.unfinished} of {found.stored} stored model calls from "
        f"{several(found.histories, 'search').replace('searchs', 'searches')} were scored under "
        f"{several(len(found.measures), 'cost')}."
    )


def _same(found: Rescored) -> list[str]:
    said = [f"{listed(group)} rank all sets in the same order." for group in found.same]
    mute = [m.name for m in found.measures if not m.tells_apart]
    return said + ([f"{listed(mute)}: the same value for all sets."] if mute else [])


def _alike(matrix: pd.DataFrame) -> list[str]:
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
    return [*said, f"{one} and {other} agree least (rank correlation {value:.2f})."]


def _regret(better: pd.DataFrame) -> list[str]:
    """Say which best set is worst under another cost."""
    worst = better.max(axis=1)
    if len(better) < 2 or worst.max() == 0.0:
        return []
    row = str(worst.idxmax())
    column = str(better.loc[row].idxmax())
    share = 100.0 * float(worst.max())
    return [
        f"The best set of {row} does worst under another cost: {column} finds {number(share)} % "
        "of the sets better."
    ]


def _valleys(measures: Sequence[OfMeasure], found: Rescored) -> list[str]:
    """Say which valleys lie apart, the farthest first."""
    apart = []
    for i, one in enumerate(measures):
        for other in measures[:i]:
            for name, at in one.valley.items():
                beside = other.valley[name]
                size = rescoring.gap((at.low, at.high), (beside.low, beside.high))
                if size > 0.0:
                    apart.append((-size, f"{other.name} and {one.name} in {name}"))
    best = f"the best {100.0 * found.valley_share:g} % of the sets"
    if not apart:
        return [f"The valleys of all costs ({best}) overlap in every parameter."]
    named = [f"{words} ({-100.0 * size:.2g} %)" for size, words in sorted(apart)[:MOST_PAIRS]]
    return [
        f"The valleys ({best}) of {several(len(apart), 'pair')} of costs lie apart in a parameter; "
        f"farthest, in per cent of the limits: {listed(named)}."
    ]


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
