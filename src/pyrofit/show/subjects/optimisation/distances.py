"""Distances of the optimisers' sets from the optimum of the likelihood."""

from dataclasses import asdict

import pandas as pd

from pyrofit.analysis.distances import distances
from pyrofit.config import Study
from pyrofit.results import identification
from pyrofit.results.files import Results
from pyrofit.show.table import Table


def distances_table(study: Study, results: Results) -> pd.DataFrame:
    """List how far the optimisers' sets are from the optimum of the likelihood.

    Distances are in standard deviations of the parameter, chi-square per degree of freedom.
    """
    found = distances(study, identification.read(study, results))
    return pd.DataFrame([asdict(one) for one in found])


TABLE = Table(
    place=60,
    make=distances_table,
    title="The optimisers' sets beside the optimum of the likelihood",
    note="The optimum weighs each point by its noise, the costs do not: their own minima, "
    "found by least squares, differ from it as well. At a limit, distances in standard deviations "
    "are only indicative.",
    headings={
        "cost_function": "cost function",
        "chi2_per_freedom": "chi-square per degree of freedom",
        "within": "parameters within 1.96 sd",
        "farthest": "farthest parameter",
        "distance_sd": "its distance [sd]",
    },
)
