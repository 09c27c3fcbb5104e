"""Which values can be published, in sentences for the first screen."""

from collections.abc import Iterator
from itertools import islice

from pyrofit.analysis.answer import estimated_twice, one_each
from pyrofit.analysis.estimates import Estimated
from pyrofit.config import Study
from pyrofit.config.check.oxidised import oxidised
from pyrofit.results.goodness import AS_DESCRIBED, ONE_RATE
from pyrofit.results.kinetics import FITTED
from pyrofit.show.apparatus import usual_errors
from pyrofit.show.facts import Facts
from pyrofit.show.goodness import of_one_rate
from pyrofit.show.names import STAGES, named_estimate
from pyrofit.show.subjects.answer.next_steps import is_physical
from pyrofit.show.text import listed, number, several

SEEN = 0.05
"""Part of a signal's variance from which on an assumption is said to matter."""
IN_BRACKETS = "In brackets: the width of the 95 % interval over the search range."


def publishable(study: Study, facts: Facts) -> Iterator[str]:
    """Yield the limits that were reached, then the parameters by verdict, then the assumptions."""
    ours = one_each(study, facts.estimates)
    yield from _at_limits([e for e in ours if e.bound])
    yield _by_verdict(study, ours)
    yield from _by_description(ours)
    yield from islice(of_one_rate([e.name for e in ours if e.grade == ONE_RATE]), 1)
    yield from _far_from_known(facts)
    yield from _kinetics_of_imp(study)
    yield from _assumed(facts)
    for sentence in oxidised(study):
        yield f"{sentence.removeprefix('experiments.')}."


def _at_limits(found: list[Estimated]) -> Iterator[str]:
    if found:
        are = "is" if len(found) == 1 else "are"
        ends = [f"{e.name} ({e.bound})" for e in found]
        yield (
            f"{listed(ends)} {are} at a limit: the best fit lies outside the limits. Such a value "
            "is the limit's, and the others depend on it."
        )


def _by_verdict(study: Study, ours: list[Estimated]) -> str:
    at_limits = {e.stage for e in ours if e.bound and not _is_none(study, e)}
    groups: dict[str, list[Estimated]] = {}
    for e in ours:
        groups.setdefault(e.grade, []).append(e)
    sure = groups.pop("determined", [])
    if sure:
        text = (
            f"The data determine {len(sure)} of {several(len(ours), 'parameter')}: "
            f"{listed([e.name for e in sure])} (95 % interval narrower than 20 % of the search "
            f"range). {_to_publish(sure, at_limits)}"
        )
    elif "apparent value" in groups:
        text = "No value can be published as a property of the material from this model."
    else:
        text = "The data determine no parameter."
    for told in ("at a limit", AS_DESCRIBED):
        groups.pop(told, None)
    parts = [f"{grade}: {listed([named_estimate(e) for e in of])}" for grade, of in groups.items()]
    if parts:
        text += f" {'; '.join(parts).capitalize()[:1]}{'; '.join(parts)[1:]}. {IN_BRACKETS}"
    loose = [e.name for e in ours if e.grade in ("weakly determined", "undetermined")]
    if loose:
        text += f" Do not quote {listed(loose)} alone: other values fit as well."
    return text


def _is_none(study: Study, e: Estimated) -> bool:
    """Tell whether it is a share of 0, which is no limit of the search alone."""
    return e.bound == "lower" and is_physical(study.parameters[e.name], e.bound)


def _to_publish(sure: list[Estimated], at_limits: set[str]) -> str:
    """Say which determined values can be published: not those of stages that reach a limit."""
    tied = [e.name for e in sure if e.stage in at_limits]
    free = [e.name for e in sure if e.stage not in at_limits]
    if not tied:
        return "Publish them with their intervals."
    text = f"Publish {listed(free)} with its interval. " if free else ""
    if len(free) > 1:
        text = text.replace("its interval", "their intervals")
    return f"{text}Intervals of {listed(tied)} hold only with the limits reached: mend these first."


def _by_description(ours: list[Estimated]) -> Iterator[str]:
    """Say which estimates rest on the description, and how far its usual errors move them."""
    if rest := [e.name for e in ours if e.grade == AS_DESCRIBED]:
        yield (
            f"Determined only if flux, thickness, h and temperatures of the tests are exactly as "
            f"described: {listed(rest)}."
        )
    sure = [e for e in ours if e.grade in ("determined", AS_DESCRIBED)]
    if moved := [e for e in sure if e.rests_on_description]:
        by = [
            f"{e.name} by ± {number(float(f'{e.apparatus:.2g}'))} {e.unit}".removesuffix(" -")
            + f" (mostly {e.most})"
            for e in moved
        ]
        yield (
            f"Usual errors of the apparatus move {listed(by)}, farther than the interval (standard "
            f"deviations: {usual_errors()}). Publish both."
        )


def _far_from_known(facts: Facts) -> Iterator[str]:
    far = [
        f"{k.estimate.name} of the {STAGES[k.estimate.stage]} by {abs(k.away_sd):.2g} sd"
        for k in facts.known
        if k.is_far
    ]
    if far:
        yield (
            f"Away from its known value: {listed(far)}. Check that value; else the estimate "
            "compensates for an effect that the model lacks."
        )


def _kinetics_of_imp(study: Study) -> Iterator[str]:
    """Say where the inverse modelling has other kinetics, or estimates a parameter again."""
    if study.kinetics is not None and study.imp.kinetics != FITTED:
        yield (
            f"The inverse modelling takes the kinetics '{study.imp.kinetics}' of the study, not "
            "the estimated ones. Its values belong to those."
        )
    if names := estimated_twice(study):
        yield (
            f"The kinetics estimate {listed(names)}, too. The answer takes the value of the "
            "inverse modelling."
        )


def _assumed(facts: Facts) -> Iterator[str]:
    if not facts.assumptions:
        return
    said = [f"{words} ({listed(tests)})" for words, tests in facts.assumptions.items()]
    text = f"Assumed, not estimated: {'; '.join(said)}."
    if facts.influence is None:
        text += " The step sensitivity tells how much they matter."
    elif parts := {k: v for k, v in facts.influence.items() if v >= SEEN}:
        shares = [f"{label} {100.0 * share:.2g} %" for label, share in parts.items()]
        text += f" Their largest parts in the variance of a signal: {listed(shares)}."
    else:
        text += f" None makes more than {100.0 * SEEN:.2g} % of the variance of a signal."
    yield text
