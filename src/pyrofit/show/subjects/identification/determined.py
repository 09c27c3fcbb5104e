"""Intervals of the parameters, and their verdicts."""

import pandas as pd

from pyrofit.analysis.estimates import Estimated, estimates_of
from pyrofit.config import Study
from pyrofit.results import identification
from pyrofit.results.files import Results
from pyrofit.show.apparatus import usual_errors
from pyrofit.show.names import STAGES
from pyrofit.show.table import Row, Table
from pyrofit.show.text import signed


def determined(study: Study, results: Results) -> pd.DataFrame:
    """List estimate, 95 % intervals and verdict of each parameter, in its own unit.

    ``low``, ``high``, ``width_percent``: with chi-square divided by its value per degree of
    freedom where that exceeds 1; ``noise_low``, ``noise_high``: as if noise were all.
    ``apparatus``: 1.96 standard deviations by usual errors of the apparatus.
    """
    estimates = estimates_of(study, identification.read(study, results))
    return pd.DataFrame([_row(study, e) for e in estimates])


def _row(study: Study, e: Estimated) -> Row:
    truth = {} if study.synthetic is None else {"truth": study.synthetic.truth.get(e.name)}
    return {
        "fit": STAGES[e.stage],
        "parameter": e.name,
        "unit": e.unit,
        **truth,
        "estimate": e.value,
        "low": e.low,
        "high": e.high,
        "width_percent": 100.0 * e.width,
        "apparatus": e.apparatus or None,
        "most": e.most or None,
        "ends": e.cut_off,
        "noise_low": e.noise_low,
        "noise_high": e.noise_high,
        "method": e.method,
        "verdict": e.verdict,
        "strongest_correlation": ""
        if e.correlation is None
        else f"{e.partner} {signed(e.correlation)}",
    }


TABLE = Table(
    place=10,
    make=determined,
    title=("95 % intervals of the parameters, and how well the data determine them"),
    note="Low, high: 95 % interval about the optimum of the likelihood. Chi-square is "
    "divided by its value per degree of freedom where that exceeds 1. 'Noise alone': "
    "without that division, where that differs. '± by the apparatus': 1.96 standard deviations by "
    f"usual errors of it ({usual_errors()}). Only intervals of a model that misses the tests have "
    "them. Width in per cent of the distance of the limits: up to 20 determined, up to 50 weakly "
    "determined, else undetermined. "
    "Linear: from the parabola of chi-square; profile: all other parameters fitted "
    "anew at each value. All intervals take the model and its other values as exact, "
    "those of the inverse modelling the kinetics as well.",
    headings={
        "low": "95 % low",
        "high": "95 % high",
        "width_percent": "width [% of search range]",
        "apparatus": "± by the apparatus",
        "most": "mostly by",
        "ends": "cut off",
        "noise_low": "noise alone, low",
        "noise_high": "noise alone, high",
        "strongest_correlation": "strongest correlation",
    },
    group_by="fit",
)
