"""Identifiability of the parameters, in sentences."""

from collections.abc import Sequence
from itertools import groupby

from pyrofit.analysis.estimates import Estimated, by_grade
from pyrofit.analysis.known_values import KnownBesideEstimate
from pyrofit.analysis.trade_offs import STRONG, TradeOff
from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.goodness import goodness_sentences
from pyrofit.show.names import STAGES, named_estimate
from pyrofit.show.text import listed, signed

SHOWN_PAIRS = 5
"""Pairs of parameters that the text names; the table has all."""


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the sentences of the section: fit, verdicts, known values, pairs."""
    fits = [
        " ".join(goodness_sentences(study, stage, STAGES[stage], found))
        for stage, found in facts.goodness.items()
    ]
    said = [*fits, verdicts(facts.estimates), *_known(facts.known)]
    return [*said, *_compensation(facts.trade_offs)]


def _known(found: Sequence[KnownBesideEstimate]) -> list[str]:
    """Name the estimates that lie far from their known values."""
    if not found:
        return []
    far = [
        f"{k.estimate.name} of the {STAGES[k.estimate.stage]} ({k.estimate.value:.4g} "
        f"{k.estimate.unit}, known {k.value:.4g} ± {k.sd:.2g}, {abs(k.away_sd):.2g} sd)"
        for k in found
        if k.is_far
    ]
    if not far:
        return ["All estimates are within 2 standard deviations of their known values."]
    return [
        f"More than 2 standard deviations from the known value: {listed(far)}. Check the known "
        "value; else the estimate compensates for an effect that the model lacks."
    ]


def verdicts(known: Sequence[Estimated]) -> str:
    """Say which parameters the data determine, which weakly, which not."""
    parts = []
    for stage, members in groupby(known, key=lambda e: e.stage):
        grades = by_grade(list(members)).items()
        said = ", ".join(
            f"{grade} {listed([named_estimate(e) for e in found])}" for grade, found in grades
        )
        parts.append(f"of the {STAGES[stage]} {said}")
    return f"By the data (width of the 95 % interval, % of the search range): {'; '.join(parts)}."


def strongest_correlation(known: Sequence[Estimated]) -> str:
    """Name the pair of the strongest correlation."""
    sizes = {e: e.correlation for e in known if e.correlation is not None}
    if not sizes:
        return "There is one parameter, hence no correlation."
    first = max(sizes, key=lambda e: abs(round(sizes[e], 2)))
    return (
        f"The strongest correlation is that of {first.name} and {first.partner}, "
        f"{signed(sizes[first])}."
    )


def _compensation(found: Sequence[TradeOff]) -> list[str]:
    """Name strongly correlated parameters, the strongest pair of the inverse modelling first."""
    strong = [p for p in found if p.stage == "imp" and abs(p.correlation) >= STRONG]
    if not strong:
        return []
    pairs = [
        f"{_change(p.name, p.rise, p.unit)} and {_change(p.partner, p.shift, p.partner_unit)}"
        for p in strong[:SHOWN_PAIRS]
    ]
    return [
        "These changes compensate each other in the inverse modelling, the strongest first: "
        f"{'; '.join(pairs)}."
    ]


def _change(name: str, by: float, unit: str) -> str:
    """Return a parameter with a signed change; a number without unit has none."""
    return f"{name} {by:+.2g}".replace("-", "−") + (f" {unit}" if unit != "-" else "")
