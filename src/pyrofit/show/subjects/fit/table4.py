"""Table 4: best sets, means and standard deviations."""

import pandas as pd

from pyrofit.analysis.estimates import estimates_of
from pyrofit.analysis.repetitions import FIT, OverRepetitions, repeated
from pyrofit.config import Study
from pyrofit.results import identification, searches
from pyrofit.results.files import Results
from pyrofit.show.names import flag
from pyrofit.show.table import Row, Table


def table4(study: Study, results: Results) -> pd.DataFrame:
    """Table 4: best set, mean and sigma over the repetitions, beside published ones.

    sigma = sqrt(sum (x - mean)^2 / (n - 1)) over n repetitions; the paper does not say which of
    n and n - 1 divides.

    Returns
    -------
    pandas.DataFrame
        One row per cost function and quantity ('fit' and each parameter, in its own unit).
    """
    repetitions = repeated(study, searches.best_of_repetitions(study, results))
    estimates = estimates_of(study, identification.read(study, results))
    by_data = {e.name: flag(e) for e in estimates if e.stage == "imp"}
    rows = [_row(study, found, by_data.get(found.name, "")) for found in repetitions]
    absent = [] if study.published else [f"published_{what}" for what in ("best", "mean", "sigma")]
    return pd.DataFrame(rows).drop(columns=absent)


def _row(study: Study, found: OverRepetitions, by_data: str) -> Row:
    published = {} if study.published is None else study.published.costs
    theirs = published.get(found.cost_function, {}).get(found.name, (None, None, None))
    return {
        "cost_function": found.cost_function,
        "quantity": found.name,
        "unit": "-" if found.name == FIT else study.parameters[found.name].unit,
        "best": found.best,
        "mean": found.mean,
        "sigma": found.sigma,
        "published_best": theirs[0],
        "published_mean": theirs[1],
        "published_sigma": theirs[2],
        "lower_limit": found.lower,
        "upper_limit": found.upper,
        "flags": "; ".join(filter(None, [flags(found), by_data])),
    }


def flags(found: OverRepetitions) -> str:
    """Say in words why an estimate is unreliable."""
    said = [f"at limit ({found.bound})"] if found.bound else []
    said += ["spread > 20 % of search range"] if found.is_wide else []
    return "; ".join(said)


TABLE = Table(
    place=20,
    make=table4,
    title="Best set, mean and standard deviation over the repetitions",
    paper="Table 4",
    note="sigma is the standard deviation over the n repetitions with n − 1 as divisor: "
    "the scatter of the optimiser, not the uncertainty of the parameter. 'At bound': "
    "the best value lies within 0.5 % of the search range from a limit. 'Spread > "
    "20 % of search range': sigma exceeds this share of it, so the repetitions disagree. "
    "'By the data': from the 95 % interval, see the table of these intervals.",
    headings={
        "published_best": "published best",
        "published_mean": "published mean",
        "published_sigma": "published sigma",
        "lower_limit": "lower limit",
        "upper_limit": "upper limit",
    },
    group_by="cost_function",
)
