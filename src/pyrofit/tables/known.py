"""Known values of parameters beside their estimates."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.tables.determined import WORDS, estimates, stages_of

FAR = 2.0
"""Standard deviations from its known value beyond which an estimate is flagged."""


def known_values(study: Study, results: Results) -> pd.DataFrame:
    """List known value, estimate and their distance of each parameter with a known value.

    Returns
    -------
    pandas.DataFrame
        One row per stage and parameter, in the parameter's unit; ``away_sd`` is (estimate -
        value) / sd of the known value.
    """
    rows = []
    for stage, names in stages_of(study).items():
        rows_of = estimates(study, results, stage).to_dict("records")
        found = {str(row["parameter"]): row for row in rows_of}
        for name in (name for name in names if name in study.known):
            known, factor = study.known[name], study.parameters[name].factor
            estimate = float(found[name]["estimate"]) / factor
            away = (estimate - known.value) / known.sd
            rows.append(
                {
                    "fit": WORDS[stage],
                    "parameter": name,
                    "unit": study.parameters[name].unit,
                    "known": known.value,
                    "known_sd": known.sd,
                    "source": known.source or None,
                    "estimate": estimate,
                    **{end: float(found[name][end]) / factor for end in ("low", "high")},
                    "away_sd": away,
                    "flag": f"more than {FAR:g} sd away" if abs(away) > FAR else None,
                }
            )
    return pd.DataFrame(rows)


def has_known(study: Study) -> bool:
    """Tell whether a stage other than the diagnosis estimates a parameter with a known value."""
    return any(name in study.known for names in stages_of(study).values() for name in names)
