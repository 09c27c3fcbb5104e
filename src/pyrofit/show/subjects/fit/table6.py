"""Table 6: the limits between which parameters are sought."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.show.table import Row, Table


def table6(study: Study, results: object) -> pd.DataFrame:
    """Table 6: sampling limits of every estimated parameter, beside the published values.

    Returns
    -------
    pandas.DataFrame
        One row per stage and parameter, in the parameter's unit. ``published_lower`` and
        ``published_upper`` are published limits. ``published_lowest`` and ``published_highest`` are
        the ends of the published best sets over the cost functions, if any.
    """
    kinetics = study.kinetics.estimate if study.kinetics else ()
    stages = (("kinetics", kinetics), ("inverse modelling", study.imp.estimate))
    rows = [_limits(study, stage, name) for stage, names in stages for name in names]
    published = study.published
    absent = [] if published else ["published_lowest", "published_highest"]
    absent += [] if published and published.limits else ["published_lower", "published_upper"]
    return pd.DataFrame(rows).drop(columns=absent)


def _limits(study: Study, stage: str, name: str) -> Row:
    parameter = study.parameters[name]
    tables = study.published.costs.values() if study.published else ()
    theirs = study.published.limits.get(name) if study.published else None
    best = [table[name][0] for table in tables if name in table]
    lower, upper = study.search_limits(name)
    return {
        "stage": stage,
        "parameter": name,
        "meaning": "; ".join(filter(None, [parameter.label, _known(study, name)])),
        "unit": parameter.unit,
        "lower_limit": lower,
        "upper_limit": upper,
        "published_lower": theirs[0] if theirs else None,
        "published_upper": theirs[1] if theirs else None,
        "published_lowest": min(best, default=None),
        "published_highest": max(best, default=None),
    }


def _known(study: Study, name: str) -> str:
    """State the search range of a parameter with a known value; nothing for others."""
    if name not in study.known:
        return ""
    known = study.known[name]
    within = f"estimated within {known.within_sds:g} sd and the limits"
    return f"known: {known.value:g} ± {known.sd:g}, {within}"


TABLE = Table(
    place=30,
    make=table6,
    title="Sampling limits",
    paper="Table 6",
    note="All optimisers search within these limits, the same for all cost functions.",
    headings={
        "lower_limit": "lower limit",
        "upper_limit": "upper limit",
        "published_lower": "published lower limit",
        "published_upper": "published upper limit",
        "published_lowest": "published best sets, lowest",
        "published_highest": "published best sets, highest",
    },
    group_by="stage",
)
