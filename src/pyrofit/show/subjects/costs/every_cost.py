"""Every best set under every cost."""

import pandas as pd

from pyrofit.analysis.uses import FITTED, title_of
from pyrofit.config import Study
from pyrofit.results.comparison import read_all_scores
from pyrofit.results.files import Results
from pyrofit.show.table import Row, Table


def every_cost(study: Study, results: Results) -> pd.DataFrame:
    """Set every best set under every cost and on the common metric, by place.

    Returns
    -------
    pandas.DataFrame
        One row per place and best set; a column for each cost function of the study and each
        metric, empty where it cannot be computed.
    """
    found = read_all_scores(results)
    best = found[found["best"]]
    rows: dict[tuple[str, str, str], Row] = {}
    for row in best.to_dict("records"):
        key = row["place"], row["cost_function"], row["found_by"]
        place = FITTED if row["place"] == FITTED else title_of(study, row["place"])
        about = {"place": place, "fitted_with": row["cost_function"], "found_by": row["found_by"]}
        rows.setdefault(key, about)[row["measure"]] = row["value"]
    frame = pd.DataFrame(list(rows.values()))
    predicted = [study.experiments[name] for name in study.validation.experiments]
    metrics = dict.fromkeys(e.metric(signal) for e in predicted for signal in e.signals)
    measures = [*study.imp.costs, *metrics]
    return frame[["place", "fitted_with", "found_by", *(m for m in measures if m in frame)]]


TABLE = Table(
    place=30,
    make=every_cost,
    title="Every best set under every cost, and on one metric",
    note="'Fitted': every cost as the searches minimised it. At an experiment that was not "
    "fitted, each cost function of the study is applied to the whole record of that "
    "experiment. The metric, over all measured points: CV(RMSE) of the mass loss rate "
    "[–], RMSE of the back temperature [K].",
    headings={"fitted_with": "fitted with", "found_by": "found by"},
    group_by="place",
)
