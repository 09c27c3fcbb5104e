"""Names, units and the leading candidate, as the diagnosis shows them."""

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.quantities.base import Quantity
from pyrofit.results.diagnosis_candidates import OfCandidate
from pyrofit.results.diagnosis_schema import Diagnosis, OfGap, OfNoise, OfWindow

BASE = "base"


CALIBRATION = "calibration"


HELD_OUT = "held out"


MOST = 12
"""Candidates and experiments that a table lists."""


CLAIMS = ("named", "ambiguous", "multiple", "partly")
"""Verdicts that claim an effect."""


MODELS = {BASE: "base model", "extended": "with the effects found"}


ROLES = {CALIBRATION: "fitted", HELD_OUT: "held out"}


def quantity_of_row(study: Study, row: OfNoise | OfGap | OfWindow) -> Quantity:
    """Return the quantity of a row that names experiment and signal."""
    return study.experiments[row.experiment].quantity(row.signal)


def words_of(study: Study, row: OfNoise | OfGap | OfWindow) -> str:
    """Return the signal of a row in words."""
    return study.experiments[row.experiment].words(row.signal)


def prediction_name(study: Study, name: str) -> str:
    """Return the title of a test that was left out of the fit, or words for the held-out tests.

    ``name`` is that of a test, "held out", or "held out: " and a laboratory or test.
    """
    if name == HELD_OUT:
        return "all held-out tests"
    place = name.removeprefix(f"{HELD_OUT}: ")
    test = study.experiments.get(place)
    title = test.title if test and test.title else place
    return title if place == name else f"{HELD_OUT}: {title}"


def effect_name(name: str) -> str:
    """Return title and name of an effect.

    >>> effect_name("k_T")
    'slope of the conductivity (k_T)'
    """
    effects = known_effects()
    title = effects[name].title if name in effects else name
    return name if title == name else f"{title} ({name})"


def setting(found: Diagnosis, name: str, default: float) -> float:
    """Return a number that steered the diagnosis, or that of diagnoses before it was one."""
    value = found.settings.get(name, default)
    return default if isinstance(value, list) else value


def leading(found: Diagnosis) -> OfCandidate | None:
    """Return the candidate that the verdict rests on, if any: the final model of the search."""
    effects = set(found.verdict.effects)
    same = [c for c in found.candidates if effects and set(c.effects) == effects]
    return min(same, key=_rank) if same else None


def _rank(candidate: OfCandidate) -> tuple[bool, bool, float]:
    """Put the final model first, then fits that were not rejected, the best ones first.

    The final model alone is tested for lack of fit. Another one with the same effects may have
    further parameters of their form, and fit better.
    """
    return candidate.adequate is None, bool(candidate.rejected), candidate.penalised


def remark_on_candidate(found: Diagnosis, candidate: OfCandidate) -> str:
    """Say why a candidate was rejected, or whether it is in the verdict if it was not."""
    kept = "in the verdict" if found.verdict.kind in CLAIMS else "not claimed"
    return candidate.rejected or kept


def ranked(found: Diagnosis, most: int | None = None) -> list[OfCandidate]:
    """Return the best fit of each set of effects, the lowest penalised chi-square first.

    The leading one is always among them, in the last place if it is worse.
    """
    best: dict[frozenset[str], OfCandidate] = {}
    for c in sorted(found.candidates, key=_rank):
        best.setdefault(frozenset(c.effects), c)
    order = sorted(best.values(), key=lambda c: c.penalised)
    chosen = leading(found)
    if most is None or chosen is None or chosen in order[:most]:
        return order[:most]
    return [*order[: most - 1], chosen]
