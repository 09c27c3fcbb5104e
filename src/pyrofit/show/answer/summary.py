"""The summary of a report in five sentences."""

import pandas as pd

from pyrofit.analysis.cost_tests import SIGNIFICANT
from pyrofit.analysis.estimates import by_grade
from pyrofit.analysis.optimisers import LOCAL_OPTIMUM, NOT_A_MINIMUM, SCEUA_AHEAD
from pyrofit.analysis.scores import Score
from pyrofit.analysis.uses import (
    FITTED,
    HELD_OUT,
    HELD_OUT_SIGNAL,
    PUBLISHED,
    fitted_experiments,
    rate_metrics,
    title_of,
)
from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.names import all_scored, costs_of, named, places_of
from pyrofit.show.table import Frames
from pyrofit.show.text import listed, several, span

_MOST = 3
"""Quantities that a sentence names one by one."""


def summary(study: Study, facts: Facts) -> list[str]:
    """Return five sentences: fit, what is determined, validation, optimisers, cost functions."""
    return [
        _fit(study, facts),
        _determined(facts),
        _validation(facts),
        _optimisers(facts.tables),
        _costs(study, facts.tables),
    ]


def _fit(study: Study, facts: Facts) -> str:
    used = fitted_experiments(study)
    where = listed([title_of(study, name) for name in study.experiments if name in used])
    fitted = [score for score in _ours(facts) if score.use == FITTED]
    text = (
        f"With {several(len(study.imp.estimate), 'parameter')} fitted to {where} by "
        f"{several(len(study.imp.costs), 'cost function')}, the best sets reproduce "
    )
    text += all_scored(fitted) if fitted else "the fitted data"
    chi2 = [found.per_point for found in facts.misfits if found.stage == "imp"]
    return (
        f"{text}; weighed by the noise, the best fit of all leaves chi-square {span(chi2)} per "
        "point, where noise alone leaves 1."
    )


def _ours(facts: Facts) -> list[Score]:
    """Return the scores of our sets; none without validation."""
    return [score for score in facts.scores if score.found_by != PUBLISHED]


def _determined(facts: Facts) -> str:
    known = facts.estimates
    groups = by_grade(known)
    sure = groups.pop("determined", [])
    text = f"The data determine {len(sure)} of {several(len(known), 'parameter')} to within 20 % "
    text += "of the limits (95 % interval)"
    parts = [f"{grade}: {listed([named(e) for e in found])}" for grade, found in groups.items()]
    return f"{text}; {'; '.join(parts)}." if parts else f"{text}."


def _validation(facts: Facts) -> str:
    free = [score for score in _ours(facts) if score.use != FITTED]
    held_out = [score for score in free if score.use == HELD_OUT]
    if not held_out:
        return "No experiment was held out, so the prediction of other experiments is untested."
    text = f"Of {places_of(held_out)}, held out, the best sets predict {all_scored(held_out)}"
    beside = [score for score in free if score.use == HELD_OUT_SIGNAL]
    more = f"; of the fitted experiments {all_scored(beside)}, not fitted there" if beside else ""
    return f"{text}{more}."


def _optimisers(tables: Frames) -> str:
    table = tables["costs"]
    by = {remark: rows.to_dict("records") for remark, rows in table.groupby("remark")}
    stuck, short = by.get(LOCAL_OPTIMUM, []), by.get(NOT_A_MINIMUM, [])
    ahead = by.get(SCEUA_AHEAD, [])
    if not stuck and not short and not ahead:
        return f"SCE-UA, least squares and CMA-ES agree on the lowest {_cost(table)} within 1 %."
    parts = [f"stopped at a local optimum for {costs_of(stuck)}"] if stuck else []
    parts += [f"had not converged for {costs_of(short)}"] if short else []
    said = []
    if parts:
        lower = [100.0 * (1.0 - row["ratio"]) for row in stuck + short]
        low, high = (f"{value:.0f}" for value in (min(lower), max(lower)))
        size = low if low == high else f"{low} to {high}"
        said.append(f"SCE-UA {' and '.join(parts)}, where others find a cost lower by {size} %")
    if ahead:
        said.append(f"SCE-UA is ahead of least squares and CMA-ES for {costs_of(ahead)}")
    if rest := len(table) - len(stuck) - len(short) - len(ahead):
        said.append(f"for {several(rest, 'cost function')} all optimisers agree within 1 %")
    return f"{'; '.join(said)}."


def _cost(table: pd.DataFrame) -> str:
    return "cost" if len(table) == 1 else f"cost of each of the {len(table)} cost functions"


def _costs(study: Study, tables: Frames) -> str:
    if len(study.imp.costs) == 1:
        return "There is one cost function, so nothing is said of its choice."
    table = tables["cost_tests"]
    changed = _changed(study, tables)
    if "p_place" not in table:
        text = f"Whether the cost functions differ was {table['verdict'].iloc[0]}"
        return f"{text}; {changed}." if changed else f"{text}."
    apart = table[table["p_place"] <= SIGNIFICANT]
    runs = several(study.imp.repetitions, "repetition")
    if apart.empty:
        text = f"Over {runs} the cost functions show no difference in {len(table)} quantities"
    else:
        names = apart.sort_values("effect", ascending=False)["quantity"].tolist()
        most = "" if len(names) <= _MOST else "most of all "
        text = (
            f"Over {runs} the cost functions differ in {len(apart)} of {len(table)} quantities "
            f"({most}{listed(names[:_MOST])})"
        )
    return f"{text}; {changed}." if changed else f"{text}."


def _changed(study: Study, tables: Frames) -> str:
    """Say how much a change of cost function and one of optimiser change the common metric."""
    table = tables["every_cost"]
    metric = next((m for m in rate_metrics(study) if m in table), None)
    if metric is None:
        return ""
    ours = table[(table["found_by"] != PUBLISHED) & table[metric].notna()]
    if ours.empty:
        return ""
    place = ours["place"].iloc[-1]
    factors = [
        ours[ours["place"] == place].groupby(by)[metric].agg(lambda v: v.max() / v.min()).max()
        for by in ("found_by", "fitted_with")
    ]
    return (
        f"among best sets, another cost function changes {metric} at {place} by a factor of up to "
        f"{span(factors[:1])}, another optimiser by up to {span(factors[1:])}"
    )
