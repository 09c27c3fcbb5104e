"""Optimisers compared, in sentences."""

from collections.abc import Mapping, Sequence

import pandas as pd

from pyrofit.analysis.distances import Distance
from pyrofit.analysis.optimisers import LOCAL_OPTIMUM, NOT_A_MINIMUM
from pyrofit.analysis.uses import FITTED, PUBLISHED, STARTED
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.show.facts import Facts
from pyrofit.show.names import costs_of
from pyrofit.show.table import Frames
from pyrofit.show.text import listed, number, span


def ahead(tables: Frames) -> str:
    """Say for which cost functions another optimiser gets lower than SCE-UA, and how surely."""
    rows = tables["costs"].to_dict("records")
    stuck = [r for r in rows if r["remark"] == LOCAL_OPTIMUM]
    short = [r for r in rows if r["remark"] == NOT_A_MINIMUM]
    if not stuck and not short:
        names = listed(STARTED)
        names = names[0].upper() + names[1:]
        return f"{names} from random starts found no cost lower by more than 1 %."
    parts = []
    for r in stuck + short:
        name = r["lowest_by"]
        by = next(key for key, one in OPTIMISERS.items() if one.words == name)
        limits = r[f"{by}_at_bound"]
        bound = f" ({limits} at a limit)" if limits and not pd.isna(limits) else ""
        agree = f"{r[f'{by}_starts_at_best']} of {r[f'{by}_starts']} starts of {name} agree"
        parts.append(f"{r['cost_function']} by {100 * (1 - r['ratio']):.0f} %, {agree}{bound}")
    text = f"Other optimisers find lower values of the same costs: {'; '.join(parts)}"
    if stuck:
        text += f". SCE-UA stopped at a local optimum for {costs_of(stuck)}"
    if short:
        text += (
            f". SCE-UA had not converged for {costs_of(short)}: least squares from its best set "
            "finds a lower cost"
        )
    return text + "."


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the sentences on the optimisers: who is ahead, distances, times."""
    said = [ahead(facts.tables), _beaten(facts.tables), _distances(facts.distances)]
    said.append(_times(facts.times))
    return [text for text in said if text]


def _beaten(tables: Frames) -> str:
    """Say where a set fitted with another cost function is the best under a cost function."""
    table = tables["every_cost"]
    fitted = table[table["place"] == FITTED]
    parts = []
    for cost in dict.fromkeys(fitted["fitted_with"]):
        own = fitted[(fitted["fitted_with"] == cost) & (fitted["found_by"] != PUBLISHED)][
            cost
        ].min()
        lowest = fitted.loc[fitted[cost].idxmin()]
        if lowest[cost] < 0.99 * own:
            parts.append(
                f"under {cost} the set fitted with {lowest['fitted_with']} by "
                f"{lowest['found_by']} has {number(float(lowest[cost]))}, those fitted with {cost} "
                f"{number(float(own))} at best"
            )
    if not parts:
        return "For each cost function, no set beats the best one fitted with it by more than 1 %."
    return f"One search may miss a set that another one finds: {'; '.join(parts)}."


def _times(times: Mapping[str, Sequence[float]]) -> str:
    """Say the wall times, where the workflow has measured those of all optimisers."""
    if not all(times.values()):
        return ""
    parts = [
        f"{by} {sum(jobs):.0f} s in {len(jobs)} job{'s' if len(jobs) > 1 else ''}"
        for by, jobs in times.items()
    ]
    return f"Wall times of this run, all cost functions: {', '.join(parts)}."


def _distances(found: Sequence[Distance]) -> str:
    parts = []
    for label in dict.fromkeys(one.set for one in found):
        here = [one for one in found if one.set == label]
        chi2 = span([one.chi2_per_freedom for one in here])
        parts.append(f"{label} {span([one.distance_sd for one in here])} sd (chi-square {chi2})")
    return (
        "Distance of the cost functions' sets from the answer in their farthest parameter, and "
        f"chi-square per degree of freedom: {'; '.join(parts)}."
    )
