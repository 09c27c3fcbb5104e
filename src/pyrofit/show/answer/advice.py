"""Which set to predict with, in sentences."""

from pyrofit.analysis.uses import FITTED, HELD_OUT
from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.names import all_scored
from pyrofit.show.text import listed, span

_WORSE = 2.0
"""Ratio of the errors held out and fitted from which a prediction is not to be trusted."""


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the advice as a list of one."""
    return [advice(study, facts)]


def advice(study: Study, facts: Facts) -> str:
    """Name the best set that fits best, each point weighed by its noise.

    It is chosen by the fit: chosen by its prediction, the held-out data would test it no more.
    """
    best = facts.best
    sets = list(zip(best["cost_function"], best["found_by"], strict=True))
    chi2 = {(d.cost_function, d.set): d.chi2_per_freedom for d in facts.distances}
    misfit = {(cost, by): chi2[cost, f"{by} best"] for cost, by in sets}
    cost, by = min(misfit, key=lambda one: misfit[one])
    least = f"chi-square per degree of freedom {span([misfit[cost, by]])}"
    others = [value for one, value in misfit.items() if one != (cost, by)]
    beside = f", of the others {span(others)}" if others else ""
    text = (
        f"To predict, use the set of {cost} ({by}) as a whole: with each point weighed by its "
        f"noise it fits best of these sets ({least}{beside})"
    )
    return f"{text}{_tested(study, facts, cost, by)}.{_together(facts)}"


def _tested(study: Study, facts: Facts, cost: str, by: str) -> str:
    """Say how well a set predicts, and whether to trust that."""
    if not study.validation.experiments:
        return ""
    mine = [s for s in facts.scores if (s.cost_function, s.found_by) == (cost, by)]
    rates = [score for score in mine if score.quantity.relative]
    held = [score for score in rates if score.use == HELD_OUT]
    if not held:
        return "; no rate was held out to test it"
    text = f"; of the held-out data, by which it was not chosen, it predicts {all_scored(held)}"
    fitted = [score for score in rates if score.use == FITTED]
    if not fitted:
        return text
    text += f", of the fitted data {all_scored(fitted)}"
    if max(s.value for s in held) > _WORSE * max(s.value for s in fitted):
        text += (
            ", so that predictions are not to be trusted before it is known what model or given "
            "values lack (snakemake diagnose)"
        )
    return text


def _together(facts: Facts) -> str:
    """Warn of values that make up for one another, and of those at a limit."""
    known = [e for e in facts.estimates if e.stage == "imp"]
    bound = [e.name for e in known if e.grade == "at a bound"]
    loose = [e.name for e in known if e.grade in ("weakly determined", "undetermined")]
    said = ""
    if loose:
        said += (
            f" Do not quote {listed(loose)} alone: other values fit as well, together with other "
            "values of the rest."
        )
    if bound:
        are, them = ("is", "it") if len(bound) == 1 else ("are", "them")
        said += f" {listed(bound)} {are} at a limit; the data would push {them} beyond it."
    return said
