"""The choice: the simplest scheme that predicts heating rates left out as well as the best one.

Schemes are compared by the log score of their predictions: the log density of each heating rate
given the others, summed over the rates. A scheme predicts as well as the best one if its sum is
lower by no more than a margin. This is three units, or the standard error of the difference over
the rates where that is larger, six at most. A scheme of a lower BIC than the best one's may lose
six: further parameters must pay both in the fit and in predictions. Of the remaining schemes, the
one with the fewest parameters is chosen; of as many, the one of the least BIC.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.logs import Tell
from pyrofit.scheme.fit import FittedScheme, SchemeSetting
from pyrofit.scheme.prediction import PredictedRecord, leave_rates_out, predict_records
from pyrofit.scheme.records import rates_of
from pyrofit.scheme.search import fit_own, search_schemes
from pyrofit.scheme.settings import SchemeSettings
from pyrofit.seeds import seed_for


@dataclass(frozen=True, eq=False)
class Candidate:
    """A fitted scheme, and its predictions of heating rates left out; none if it is hopeless."""

    fitted: FittedScheme
    left_out: tuple[PredictedRecord, ...]

    @property
    def log_score(self) -> float:
        """Log density of all heating rates, each given the others."""
        return sum(p.log_score for p in self.left_out)

    @property
    def left_out_rms(self) -> float:
        """Root mean square of the predictions' errors."""
        return float(np.sqrt(np.mean([p.rms**2 for p in self.left_out])))

    def by_rate(self) -> dict[float, float]:
        """Return the log score by heating rate."""
        return {
            rate: sum(p.log_score for p in self.left_out if p.record.rate == rate)
            for rate in rates_of([p.record for p in self.left_out])
        }


@dataclass(frozen=True, eq=False)
class Choice:
    """All fitted schemes, the chosen one, and the one that predicts best.

    ``own`` is the scheme that the study describes, for comparison. ``margins`` are the log scores
    that each predicting scheme may lose to the best. ``held_out`` are the predictions of records
    that no scheme is fitted to. Both are by name.
    """

    candidates: tuple[Candidate, ...]
    own: Candidate
    chosen: Candidate
    best: Candidate
    margins: dict[str, float]
    held_out: dict[str, tuple[PredictedRecord, ...]]

    @property
    def gain(self) -> float:
        """Log score of the chosen scheme above that of the study's."""
        return self.chosen.log_score - self.own.log_score


def choose_scheme(setting: SchemeSetting, tell: Tell) -> Choice:
    """Fit schemes, let them predict, and choose.

    Raises
    ------
    DataError
        No scheme can be simulated within its limits.
    """
    fitted = search_schemes(setting, tell)
    hopeless = fitted[0].bic + setting.settings.hopeless_bic
    candidates = [
        _candidate(setting, f, tell) if f.bic <= hopeless else Candidate(f, ()) for f in fitted
    ]
    best, chosen, margins = choose(candidates, setting.settings)
    own = _candidate(setting, fit_own(setting), tell)
    others = [r for r in setting.records if not r.calibrated]
    held_out = {
        c.fitted.name: tuple(predict_records(setting, c.fitted, others)) for c in [*candidates, own]
    }
    return Choice(tuple(candidates), own, chosen, best, margins, held_out)


def _candidate(setting: SchemeSetting, fitted: FittedScheme, tell: Tell) -> Candidate:
    seed = seed_for(setting.study.seed, "left out", fitted.name)
    made = Candidate(fitted, tuple(leave_rates_out(setting, fitted, seed)))
    tell(f"{fitted.posed.words}: log score {made.log_score:.1f} of rates left out")
    return made


def choose(
    candidates: Sequence[Candidate], settings: SchemeSettings
) -> tuple[Candidate, Candidate, dict[str, float]]:
    """Return the candidate that predicts best, the chosen one, and the margins by scheme."""
    able = [c for c in candidates if c.left_out]
    best = max(able, key=lambda c: c.log_score)
    margins = {c.fitted.name: margin(best, c, settings) for c in able}
    good = [c for c in able if best.log_score - c.log_score <= margins[c.fitted.name]]
    chosen = min(good, key=lambda c: (c.fitted.posed.count, c.fitted.bic))
    return best, chosen, margins


def margin(best: Candidate, other: Candidate, settings: SchemeSettings) -> float:
    """Return the log score that a candidate may lose to the best one."""
    if other.fitted.bic < best.fitted.bic:
        return settings.largest_margin
    one, two = best.by_rate(), other.by_rate()
    lost = np.array([one[rate] - two[rate] for rate in one])
    error = float(np.std(lost, ddof=1) * np.sqrt(lost.size)) if lost.size > 1 else 0.0
    return max(settings.as_good, min(error, settings.largest_margin))
