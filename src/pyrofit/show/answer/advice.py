"""Which set to predict with, in sentences."""

from pyrofit.analysis.optimisers import LOCAL_OPTIMUM, NOT_A_MINIMUM
from pyrofit.analysis.recommended import Recommended, recommended
from pyrofit.analysis.uses import FITTED, SCEUA
from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.names import all_scored
from pyrofit.show.text import several, span

_WORSE = 2.0
"""Ratio of errors, or of chi-square, from which one is said to be worse than another."""


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the advice as a list of one."""
    return [advice(study, facts)]


def advice(study: Study, facts: Facts) -> str:
    """Name the ensemble where there is one, and the set that predicts best, else fits best.

    Experiments that were held out tell which set predicts best.
    """
    chosen = recommended(facts.scores, facts.distances)
    one = f"all values of the best set of {chosen.cost_function} ({chosen.found_by}). "
    text = f"To predict, use {one}"
    if facts.ensemble:
        text = (
            f"To predict, use the ensemble of {facts.ensemble} sets (posterior/ensemble.csv): its "
            f"bands show the uncertainty of the prediction. If you need one set, use {one}"
        )
    elif not facts.goodness["imp"].describes:
        text = (
            "The model of the inverse modelling misses its tests, so expect errors of that size "
            f"or larger in a prediction. If you must predict, use {one}"
        )
    reason = _by_prediction if chosen.held_out else _by_fit
    return text + reason(chosen, facts) + _not_lowest(chosen, facts)


def _by_prediction(chosen: Recommended, facts: Facts) -> str:
    mine = chosen.of(chosen.held_out)
    text = f"It predicts data that no cost function was fitted to: {all_scored(mine)}"
    if chosen.sets > 1:
        text = (
            f"Of {several(chosen.sets, 'set')}, this one predicts the held-out experiments best: "
            f"{all_scored(mine)} (all sets: {all_scored(chosen.held_out)}). The choice used these "
            "data, so they do not validate it"
        )
    fitted = [s for s in chosen.of(facts.scores) if s.use == FITTED and s.quantity.relative]
    held_out = [s.value for s in mine if s.quantity.relative]
    if fitted and held_out and max(held_out) > _WORSE * max(s.value for s in fitted):
        text += (
            f". The error there is more than twice that of the fitted data ({all_scored(fitted)}): "
            "find first which effect the model lacks (snakemake diagnose)"
        )
    return f"{text}.{_worse_fit(chosen, facts)}"


def _worse_fit(chosen: Recommended, facts: Facts) -> str:
    """Say where the set that predicts best fits the fitted data clearly worse than another."""
    mine = _misfit(chosen, facts)
    least = min(d.chi2_per_freedom for d in facts.distances)
    if mine < _WORSE * least:
        return ""
    return (
        f" It fits worse than the best fit (chi-square per degree of freedom {span([mine])} "
        f"against {span([least])}). Possible reasons are chance, a missing effect, or a wrong "
        "noise model."
    )


def _not_lowest(chosen: Recommended, facts: Facts) -> str:
    """Say where another optimiser lowers the cost that a set of SCE-UA was fitted with."""
    rows = facts.tables["costs"]
    mine = rows[rows["cost_function"] == chosen.cost_function]
    if chosen.found_by != SCEUA or not mine["remark"].isin([LOCAL_OPTIMUM, NOT_A_MINIMUM]).any():
        return ""
    return f" Another optimiser finds a set with a lower {chosen.cost_function}."


def _misfit(chosen: Recommended, facts: Facts) -> float:
    chi2 = {(d.cost_function, d.set): d.chi2_per_freedom for d in facts.distances}
    return chi2[chosen.cost_function, f"{chosen.found_by} best"]


def _by_fit(chosen: Recommended, facts: Facts) -> str:
    mine = _misfit(chosen, facts)
    return (
        f"Of {several(chosen.sets, 'set')}, this one fits best, each point weighed by its noise "
        f"(chi-square per degree of freedom {span([mine])}). No experiment was held out, so the "
        "prediction of other experiments is untested."
    )
