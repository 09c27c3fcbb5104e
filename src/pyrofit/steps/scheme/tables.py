"""The schemes in order of how well they predict, and the parameters of the chosen one."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.table import Row, Table
from pyrofit.steps.scheme import record
from pyrofit.steps.scheme.record import OfScheme


def schemes(study: Study, results: Results) -> pd.DataFrame:
    """List the schemes, best prediction first, those without predictions by BIC behind them."""
    found = record.read(study, results)
    least = min(s.bic for s in found.schemes)
    ordered = sorted(
        [*found.schemes, found.own],
        key=lambda s: (s.log_score is None, -(s.log_score or 0.0), s.bic),
    )
    return pd.DataFrame([_row(s, s.name == found.chosen, least) for s in ordered])


def _row(s: OfScheme, chosen: bool, least: float) -> Row:
    return {
        "scheme": s.words,
        "chosen": "chosen" if chosen else "",
        "parameters": s.parameters,
        "bic": s.bic - least,
        "log_score": s.log_score,
        "rms": s.rms,
        "predicted_rms": s.predicted_rms,
        "held_out_rms": s.held_out_rms,
        "discrepancy": s.discrepancy,
    }


def scheme_parameters_table(study: Study, results: Results) -> pd.DataFrame:
    """List the parameters of the chosen scheme."""
    found = record.read(study, results)
    return pd.DataFrame(
        [
            {
                "parameter": name,
                "meaning": p.label,
                "value": p.value,
                "low": p.low,
                "high": p.high,
                "unit": p.unit,
                "remark": "at a limit" if p.at_limit else "",
            }
            for name, p in found.parameters.items()
        ]
    )


SCHEMES = Table(
    place=60,
    make=schemes,
    title="Reaction schemes and their predictions",
    note="BIC: above the least one. Log score: log density of all heating rates, each "
    "predicted by a fit to the others; the higher, the better. Deviations are root "
    "mean squares of the mass over the initial mass. They are given for the fit, for "
    "heating rates left out of it, and for records that were not fitted. Left over: "
    "standard deviation of the misfit beyond the noise.",
    headings={
        "bic": "BIC",
        "log_score": "log score",
        "rms": "fit",
        "predicted_rms": "rates left out",
        "held_out_rms": "records not fitted",
        "discrepancy": "left over",
    },
)
PARAMETERS = Table(
    place=70,
    make=scheme_parameters_table,
    title="Parameters of the chosen scheme",
    note="Linear 95 % intervals within the limits. A reference temperature is that at which the "
    "rate constant is 0.001 1/s.",
)
