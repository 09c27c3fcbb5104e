"""The posterior in tables: parameters, correlations, model discrepancy, bands."""

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.table import Table
from pyrofit.steps.posterior import record


def parameters_table_of_draws(study: Study, results: Results) -> pd.DataFrame:
    """List mean, sd, interval and convergence of each parameter, in the study's units."""
    rows = []
    for of in record.read(study, results).parameters:
        parameter = study.parameters[of.name]
        values = {k: getattr(of, k) / parameter.factor for k in ("mean", "sd", "low", "high")}
        rows.append(
            {"parameter": of.name, "unit": parameter.unit, **values, "rhat": of.rhat, "ess": of.ess}
        )
    return pd.DataFrame(rows)


def correlations_table(study: Study, results: Results) -> pd.DataFrame:
    """List the correlation of each two parameters, the strongest first."""
    matrix = record.read_correlation(study, results)
    names = list(matrix)
    values = matrix.to_numpy(float)
    pairs = [(i, k) for i in range(len(names)) for k in range(i)]
    pairs.sort(key=lambda pair: -abs(values[pair]))
    return pd.DataFrame(
        [(names[k], names[i], values[i, k]) for i, k in pairs],
        columns=["parameter", "other", "correlation"],
    )


def lacking_table(study: Study, results: Results) -> pd.DataFrame:
    """List the model discrepancy of each fitted signal."""
    found = record.read(study, results).discrepancies
    return pd.DataFrame(
        [
            {
                "experiment": of.experiment,
                "signal": of.signal,
                "level [%]": 100.0 * of.level,
                "time [%]": 100.0 * of.time,
                "offset [%]": 100.0 * of.offset,
                "lasting [–]": of.lasting,
            }
            for of in found
        ]
    )


def bands_table(study: Study, results: Results) -> pd.DataFrame:
    """List the widths of the bands, and the share of the measured points inside."""
    found = record.read(study, results).bands
    return pd.DataFrame(
        [
            {
                "experiment": of.experiment,
                "signal": of.signal,
                "role": of.role,
                "parameters [%]": 100.0 * of.parameters_width,
                "width [%]": 100.0 * of.width if of.lacking else np.nan,
                "inside [%]": np.nan if of.inside is None else 100.0 * of.inside,
            }
            for of in found
        ]
    )


TABLES = {
    "parameters": Table(
        place=60,
        make=parameters_table_of_draws,
        title="Parameters by sampling",
        note="95 % interval: 2.5 and 97.5 % quantiles of the draws. R-hat compares independent "
        "ensembles: below 1.05 they agree. ESS: effective sample size.",
        headings={
            "low": "95 % from",
            "high": "95 % to",
            "rhat": "R-hat",
            "ess": "ESS",
        },
    ),
    "correlations": Table(
        place=70,
        make=correlations_table,
        title="Correlation of the parameters by sampling",
        shown=False,
    ),
    "lacking": Table(
        place=80,
        make=lacking_table,
        title="Model discrepancy of each fitted signal",
        note="Standard deviations of the relative errors of level and time, and of the offset over "
        "the range of the curve. The correlation time is divided by the time at which the total "
        "variation of the curve reaches half of its final value.",
        headings={"lasting": "correlation time"},
    ),
    "bands": Table(
        place=90,
        make=bands_table,
        title="Widths of the 95 % bands",
        note="Mean widths over the range of the curve, for parameters alone and with model "
        "discrepancy. The last column is the share of measured points within the band of new "
        "measurements, noise included. A cell is empty if no fitted experiment determines the "
        "discrepancy, or if nothing was measured.",
        headings={
            "parameters": "parameters alone",
            "width": "with model discrepancy",
            "inside": "points inside",
        },
    ),
}
