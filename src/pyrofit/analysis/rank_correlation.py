"""Correlation of the parameters over the repetitions."""

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results import searches
from pyrofit.results.files import Results


def rank_correlation(study: Study, results: Results) -> pd.DataFrame:
    """Return Spearman's correlation of the parameters, ranked within each cost function.

    Differences between cost functions do not count as correlation. A parameter that always ends at
    the same value has no correlation; its entry is 0.
    """
    names = list(study.imp.estimate)
    summary = searches.best_of_repetitions(study, results)
    ranks = summary.groupby("cost_function")[names].rank()
    ranks = ranks - ranks.groupby(summary["cost_function"]).transform("mean")
    matrix = ranks.corr().fillna(0.0).to_numpy(copy=True)
    np.fill_diagonal(matrix, 1.0)
    return pd.DataFrame(matrix, index=names, columns=names)
