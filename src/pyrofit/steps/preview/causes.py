"""Likely causes of records outside the band: the corrections that bring them inside."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.config import Study
from pyrofit.steps.preview.corrections import possible_corrections
from pyrofit.steps.preview.fit import Nearest, nearest, relative_misfits
from pyrofit.steps.preview.likely_cause import LIMITS, ORDER, SAMPLE, LikelyCause
from pyrofit.steps.preview.reach import (
    OUTSIDE,
    Channel,
    Curves,
    Reached,
    RecordedCases,
    all_reached,
    peak_off,
    simulate_all,
)
from pyrofit.steps.preview.record import Likely
from pyrofit.steps.preview.sets import Sets

TRIED_SETS = 64
"""Sets that a correction is tried with first."""
FEWEST_FITS, MOST_FITS, FITTED_TESTS = 4, 10, 60
"""Corrections that are fitted, those that look best before: as many as make 60 fits of a test."""
FAR, FARTHEST = 0.06, 0.20
"""Differences of the nearest set over the range from which on causes are looked for: root mean
square over all records, and of a single one. Studies as shipped have 0.05 and 0.14 at most."""
MOST_OF_A_KIND = 2
"""Corrections of one kind at one place that are fitted."""
AT_LIMIT, BESIDE = 0.02, 15
"""Distance from a limit that counts as at it, over the range; sets drawn within wider limits."""
EXPLAINS = 0.5
"""Share of the squared difference that a cause must take away."""
NEAR = 0.1
"""Largest difference that a cause may leave, over the range, of its own records and of all."""
NEARLY_ALL = 0.9
"""Share from which on a cause may leave more, up to `FARTHEST`: the rest is of the model."""
OF_LIMITS = 1.3
"""Factor of the difference of wider limits: more freedom fits better whatever the cause is."""
BESIDE_BEST, BESIDE_LEAST = 3.0, 0.03
"""A cause is named up to so many times what the best one leaves, and so much more."""
MOST_CAUSES = 4
BY_TENS = 10.0
"""Factor by which a peak lies beside those of most sets, from which on no limit explains it."""


def suspects(found: Mapping[Channel, Reached], left: Mapping[Channel, float]) -> list[Channel]:
    """Return the records for which causes are looked for; none of an honest study.

    Parameters
    ----------
    found
        Records beside the band.
    left
        Difference of each record from the set that comes nearest to all, over the range.
    """
    outside = [channel for channel, one in found.items() if one.outside > OUTSIDE]
    if not outside and not is_far(left):
        return []
    far = [channel for channel, size in left.items() if size > 0.5 * FAR]
    return list(dict.fromkeys([*outside, *far]))


def is_far(left: Mapping[Channel, float]) -> bool:
    """Tell whether no set comes near all records at once."""
    alone = max(left.values(), default=0.0)
    return alone > FARTHEST or _mean_square(left) > FAR**2


def likely(
    study: Study,
    case: RecordedCases,
    sets: Sets,
    suspected: Sequence[Channel],
    mostly: Collection[Channel],
    before: Nearest,
) -> list[Likely]:
    """Return the causes whose corrections bring sets near the records, the likeliest first.

    Each correction is tried with a few sets, and the best ones are fitted. Limits are fitted where
    the nearest set lies at one. A factor may undo a peak that is ten times beside those of the
    sets. It is the cause where only wider limits explain the record, whatever else is missed.

    Parameters
    ----------
    study, case, sets
        The study, its records and sets.
    suspected
        Records for which causes are looked for.
    mostly
        Records that lie beside the band for the most part.
    before
        The set that comes nearest to all records, as they are described.
    """
    few = sets.first(TRIED_SETS)
    known = simulate_all(study, case, few)
    tried = [
        _tried(study, case, few, known, one)
        for one in possible_corrections(case, suspected, mostly)
    ]
    able = [one for one in tried if one is not None]
    total = _mean_square(before.left)
    found = []
    for one in (*_chosen(case, able), *_wider_limits(study, case, sets, before)):
        cause, sizes = _judged(study, one, total)
        allowed = FARTHEST if cause.explained >= NEARLY_ALL else NEAR
        if max([*sizes, cause.left]) <= allowed:
            found.append(cause)
    least = min((cause.left for cause in found), default=0.0)
    most = BESIDE_BEST * least + BESIDE_LEAST
    good = [cause for cause in found if cause.explained >= EXPLAINS and cause.left <= most]
    if all(cause.cause == LIMITS for cause in good):
        by_tens = [one for one in able if _undoes_tens(case, known, one)]
        good = [_judged(study, one, total)[0] for one in _chosen(case, by_tens)] or good
    return _distinct(sorted(good, key=_rank))


def _judged(study: Study, one: "_Tried", total: float) -> tuple[Likely, list[float]]:
    """Return a cause, and what it leaves of the records of its own places, over the range."""
    cause = one.correction
    apart = nearest(study, one.case, one.sets, one.curves).left
    left = _mean_square(apart)
    likely_one = Likely(
        cause=cause.cause,
        places=list(cause.places),
        words=cause.words,
        explained=1.0 - left / total,
        left=float(np.sqrt(left)),
    )
    return likely_one, [size for (name, _), size in apart.items() if name in cause.places]


def _mean_square(left: Mapping[Channel, float]) -> float:
    return float(np.mean(np.square(list(left.values())))) if left else 0.0


def _rank(cause: Likely) -> tuple[float, int]:
    return cause.left * (OF_LIMITS if cause.cause == LIMITS else 1.0), ORDER.index(cause.cause)


def _distinct(causes: Iterable[Likely]) -> list[Likely]:
    """Return the best of each kind of cause at each place."""
    best: dict[tuple[str, ...], Likely] = {}
    for cause in causes:
        best.setdefault((cause.cause, *cause.places), cause)
    return list(best.values())[:MOST_CAUSES]


@dataclass(frozen=True, eq=False)
class _Tried:
    """A correction with the corrected case, its sets and their curves."""

    correction: LikelyCause
    case: RecordedCases
    sets: Sets
    curves: Curves

    @property
    def first(self) -> float:
        """Mean square difference of the best set drawn."""
        squares = relative_misfits(all_reached(self.case, self.curves)) ** 2
        return float(np.min(np.mean(squares, axis=1)))


def _undoes_tens(case: RecordedCases, known: Curves, one: _Tried) -> bool:
    """Tell whether a factor of values brings a peak that is ten times off among those of sets."""
    changed = [c for c, frame in one.case.frames.items() if frame is not case.frames[c]]
    before, after = all_reached(case, known), all_reached(one.case, one.curves)
    return one.correction.cause == SAMPLE and any(
        peak_off(before[c].value, known[c]) >= BY_TENS
        and peak_off(after[c].value, one.curves[c]) == 1.0
        for c in changed
    )


def _tried(
    study: Study, case: RecordedCases, sets: Sets, known: Curves, correction: LikelyCause
) -> _Tried | None:
    """Return a correction that was tried; none if the description does not allow it."""
    try:
        corrected = correction.change(case)
    except ValueError:
        return None
    curves = simulate_all(study, corrected, sets, (case, known))
    return _Tried(correction, corrected, sets, curves)


def _chosen(case: RecordedCases, tried: list[_Tried]) -> list[_Tried]:
    """Return the corrections that are fitted: the best, two of a kind at a place at most."""
    tests = max(len({name for name, _ in case.frames}), 1)
    fits = min(max(FITTED_TESTS // tests, FEWEST_FITS), MOST_FITS)
    counts: Counter[tuple[str, tuple[str, ...]]] = Counter()
    chosen = []
    for one in sorted(tried, key=lambda one: one.first):
        key = one.correction.cause, one.correction.places
        counts[key] += 1
        if counts[key] <= MOST_OF_A_KIND:
            chosen.append(one)
    return chosen[:fits]


def _wider_limits(
    study: Study, case: RecordedCases, sets: Sets, before: Nearest
) -> Iterator[_Tried]:
    """Yield wider limits of the parameters that the nearest set has at a limit."""
    for i, name in enumerate(sets.names):
        at = float(before.unit[i])
        if AT_LIMIT < at < 1.0 - AT_LIMIT:
            continue
        p, low, high = study.parameters[name], float(sets.low[i]), float(sets.high[i])
        new = _wider(low, high, p.unit)
        wider = sets.first(BESIDE).widened(name, *new)
        unit = before.unit.copy()
        unit[i] = (low + at * (high - low) - new[0]) / (new[1] - new[0])
        wider = replace(wider, unit=np.vstack([unit, wider.unit]))
        words = f"the limits of {name}, {p.lower:g} to {p.upper:g} {p.unit}, are too narrow"
        correction = LikelyCause(LIMITS, (name,), words, lambda case: case)
        yield _Tried(correction, case, wider, simulate_all(study, case, wider))


def _wider(low: float, high: float, unit: str) -> tuple[float, float]:
    """Return limits that are wider by the larger of their distance and three quarters of each.

    Fractions stay fractions; of temperatures it is a fifth.
    """
    share = 0.2 if unit == "K" else 0.75
    span = high - low
    new = low - max(span, share * abs(low)), high + max(span, share * abs(high))
    least = 0.1 * low if low > 0.0 else 0.0 if unit == "-" and low == 0.0 else new[0]
    most = 1.0 if unit == "-" and high <= 1.0 else new[1]
    return max(new[0], least), min(new[1], most)
