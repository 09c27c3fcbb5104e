"""Results of the diagnosis, in sentences."""

import math
from collections.abc import Iterable, Mapping, Sequence

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.results.diagnosis_candidates import OfCandidate
from pyrofit.results.diagnosis_schema import Diagnosis, OfGap, OfNoise, OfParameter
from pyrofit.show.diagnosis.words import (
    CALIBRATION,
    HELD_OUT,
    ROLES,
    effect_name,
    leading,
    setting,
    words_of,
)
from pyrofit.show.text import listed, number

_TOO_FEW = ", too few to distinguish them"


def summary_sentences(found: Diagnosis) -> list[str]:
    """Return the sentences of a summary: verdict, where, the gap, the next experiment."""
    said = [found.verdict.words, where_off(found), gap_closed(found)]
    return said + ([next_measured(found)] if found.next_experiment else [])


def where_off(found: Diagnosis) -> str:
    """Say how large the misfit of the base model is, and where."""
    here = [w for w in found.windows if w.model == "base"]
    base = found.base
    side = "above" if base.chi2 > base.chi2_critical else "below"
    text = (
        f"Chi-square of the base model is {number(base.chi2)} on {base.points} points, "
        f"{side} the critical value of {number(base.chi2_critical)} (1 %)."
    )
    if not here:
        return f"{text} No interval of a curve has significant residuals of one sign."
    phases = list(dict.fromkeys(w.phase for w in here))
    where = "One interval has" if len(here) == 1 else f"{len(here)} intervals have"
    said = f"{text} {where} significant residuals of one sign: {listed(phases)}."
    if side == "above":
        return said
    return f"{said} Chi-square shows no lack of fit; the test of intervals does."


def missing_sentences(found: Diagnosis) -> str:
    """Return sentences on the findings."""
    return " ".join([_found(found), *_determined(found)])


def _determined(found: Diagnosis) -> list[str]:
    """Say which products of an effect's parameters the data determine better than each of them."""
    said = []
    chosen = leading(found)
    for ridge in chosen.ridges if chosen else []:
        quantities = known_effects()[ridge.effect].quantities
        factors = [
            f"({quantities[name].label})" + (f"^{power:g}" if power != 1.0 else "")
            for name, power in ridge.exponents.items()
        ]
        alone = listed([f"{100.0 * sd:.2g} %" for sd in ridge.alone.values()])
        said.append(
            f"Of {effect_name(ridge.effect)}, the data determine the product "
            f"{' '.join(factors)} to {100.0 * ridge.relative_sd:.2g} % (standard deviation), "
            f"each factor to {alone}."
        )
    return said


def _found(found: Diagnosis) -> str:
    chosen = leading(found)
    if not found.candidates:
        return "No effect was fitted."
    if chosen is None:
        return f"An effect must lower chi-square by {number(found.needed)} to be claimed."
    names = listed([effect_name(name) for name in chosen.effects])
    return (
        f"Chi-square falls from {number(found.base.chi2)} to {number(chosen.chi2)} with "
        f"{names}.{_without_one(found, chosen)} An effect must lower it by "
        f"{number(found.needed)} to be claimed."
    )


def _without_one(found: Diagnosis, chosen: OfCandidate) -> str:
    """Say how much higher chi-square is without one of several effects, where that was fitted."""
    effects = set(chosen.effects)
    if len(effects) == 1:
        return ""
    lowest: dict[str, float] = {}
    for candidate in found.candidates:
        left = effects - set(candidate.effects)
        if len(left) == 1 and set(candidate.effects) < effects:
            (name,) = left
            lowest[name] = min(lowest.get(name, math.inf), candidate.chi2)
    rises = [
        f"{number(chi2 - chosen.chi2)} without {name}" for name, chi2 in sorted(lowest.items())
    ]
    return f" It is higher by {listed(rises)}." if rises else ""


def gap_closed(found: Diagnosis) -> str:
    """Say how large the residuals are, fitted and held out, and where predictions get worse."""
    parts = []
    for role in dict.fromkeys(g.role for g in found.gap):
        rows = [g for g in found.gap if g.role == role]
        points = sum(g.points for g in rows)
        before = (sum(g.chi2_before for g in rows) / points) ** 0.5
        after = (sum(g.chi2_after for g in rows) / points) ** 0.5
        change = f" to {after:.3g}" if found.verdict.effects else ""
        start = "from " if change else ""
        parts.append(f"{start}{before:.3g}{change} ({ROLES.get(role, role)})")
    verb = "goes" if found.verdict.effects else "is"
    return (
        f"The root mean square of the whitened residuals {verb} {listed(parts)}. Noise alone gives "
        f"1; less is usual where the noise includes a lasting error.{_larger_errors(found)}"
    )


def _larger_errors(found: Diagnosis) -> str:
    """Say of how many held-out signals the error rises, apart those that can tell and cannot."""
    rows = [g for g in found.gap if g.role == HELD_OUT]
    if not found.verdict.effects or not rows:
        return ""
    telling = [g for g in rows if g.tells]
    other = [g for g in rows if not g.tells]
    said = ""
    if telling:
        said += (
            f" The root mean square error rises with the effects for {_rising(telling)} of "
            f"{len(telling)} held-out signals that can tell whether an effect is real."
        )
        if _rising(telling):
            said += (
                " The log score may improve all the same: it weighs errors by the uncertainty of "
                "the prediction and by correlated noise."
            )
    if other:
        said += (
            f" Held-out signals that cannot tell: {len(other)}, of these {_rising(other)} with a "
            "larger error. Their noise and their uncertain apparatus hide the effects."
        )
    return said


def _rising(rows: Sequence[OfGap]) -> int:
    return sum(g.rms_after > g.rms_before for g in rows)


def certainty(study: Study, found: Diagnosis) -> str:
    """State the evidence for the verdict besides the fit, and the evidence against it."""
    chosen = leading(found)
    said = [_at_limits("base model", found.base.parameters)]
    if chosen is not None:
        said.append(_at_limits("model with the effects", found.extended.parameters))
    said += _of_noise(study, found)
    if chosen is None:
        return " ".join(said)
    if chosen.adequate is not None:
        left = "agrees with the data within" if chosen.adequate else "still differs by more than"
        said.append(f"With the effects found, the model {left} the noise.")
    return " ".join([*said, *_thresholds(found)])


def _at_limits(model: str, parameters: Mapping[str, OfParameter]) -> str:
    bound = [name for name, p in parameters.items() if p.at_limit]
    if not bound:
        return f"No parameter of the {model} is at a limit."
    return f"In the {model}, {listed(bound)} {'is' if len(bound) == 1 else 'are'} at a limit."


def _thresholds(found: Diagnosis) -> list[str]:
    """State the thresholds of the tests whose results are listed for each effect."""
    verdict = found.verdict
    said = []
    if any(evidence.predictions for evidence in verdict.evidence):
        gain = setting(found, "informative_gain", 2.0)
        alone = setting(found, "deciding_gain", gain)
        said.append(
            f"A claim needs a total rise of the log score by {gain:g}. No test that promises "
            f"{alone:g} or more may fall by {gain:g}; one held-out laboratory may be an exception."
        )
    if any(evidence.agreement is not None for evidence in verdict.evidence):
        level = number(setting(found, "agreement_level", 0.001))
        firm = number(setting(found, "firm_agreement", 0.05))
        said.append(
            f"The test of equal strengths needs a p above {level}, beside other misfit {firm}."
        )
    if any(verdict.other_terms):
        limit = setting(found, "certain_evidence", found.ambiguity)
        said.append(
            "A confirmed name needs a -2 ln marginal likelihood of the best free correction that "
            f"is more than {limit:g} above that of the effect."
        )
    return said


def _of_noise(study: Study, found: Diagnosis) -> list[str]:
    """Say of which fitted series the noise is not well known: all rests on it."""

    def those(series: Iterable[OfNoise]) -> str:
        return listed([f"{title_of(study, n.experiment)}, {words_of(study, n)}" for n in series])

    fitted = [n for n in found.noise if n.role == CALIBRATION]
    estimated = those(n for n in fitted if not n.stated)
    lasting = those(n for n in fitted if not n.white)
    said = [f"No uncertainty is given, so that the noise is estimated: {estimated}."]
    return said * bool(estimated) + [
        "Some correlation remains in the noise of these series, so that the tests are less "
        f"reliable: {lasting}."
    ] * bool(lasting)


def next_measured(found: Diagnosis) -> str:
    """Say which experiment would separate competing models best."""
    if not found.next_experiment:
        return "No experiment is proposed: there are no two models to distinguish."
    best = max(found.next_experiment, key=lambda d: d.separation_sd)
    short = best.separation_sd**2 < found.ambiguity
    return (
        f"Of new experiments, this would separate competing models best: {best.words}; by "
        f"{best.separation_sd:.1f} standard deviations{_TOO_FEW if short else ''}."
    )
