"""Noise of the signals, and how the base fits them."""

import pandas as pd

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import ROLES, quantity_of_row, words_of
from pyrofit.show.table import Table
from pyrofit.show.units import difference, difference_unit


def noise_table(study: Study, results: Results) -> pd.DataFrame:
    """List the noise of every channel, and how the base fits or predicts it."""
    rows = []
    for n in diagnosis.read(study, results).noise:
        quantity = quantity_of_row(study, n)
        rows.append(
            {
                "role": ROLES.get(n.role, n.role),
                "experiment": title_of(study, n.experiment),
                "signal": words_of(study, n),
                "points": int(n.points),
                "sd_median": float(difference(quantity, n.sd_median)),
                "unit": difference_unit(quantity),
                "noise": n.words,
                "chi2_per_point": n.chi2_base / n.points,
            }
        )
    return pd.DataFrame(rows)


TABLE = Table(
    place=710,
    make=noise_table,
    title="Noise of the signals, and how the base fits them",
    note="Stated with the data or estimated from their scatter, as the column noise says; sd is "
    "the median standard deviation. Chi-square per point is near 1 where the base model misses "
    "the data by noise alone.",
    headings={"sd_median": "sd", "chi2_per_point": "chi-square per point"},
    group_by="role",
)
