"""Errors before and after the effects of the verdict were added."""

import numpy as np
import pandas as pd

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import ROLES, quantity_of_row, words_of
from pyrofit.show.table import Table
from pyrofit.show.units import difference, difference_unit


def gap_table(study: Study, results: Results) -> pd.DataFrame:
    """List how far model and measurement are apart, before and after, fitted and held out.

    ``before_sd``, ``after_sd``: root of chi-square per point; 1 is noise alone. Without named
    effects there is no after.
    """
    found = diagnosis.read(study, results)
    rows = []
    for g in found.gap:
        quantity = quantity_of_row(study, g)
        before, after = (float(difference(quantity, v)) for v in (g.rms_before, g.rms_after))
        rows.append(
            {
                "role": ROLES.get(g.role, g.role),
                "experiment": title_of(study, g.experiment),
                "signal": words_of(study, g),
                "tells": {True: "yes", False: "no", None: None}[g.tells],
                "points": g.points,
                "rms_before": before,
                "rms_after": after,
                "noise_sd": float(difference(quantity, g.noise_sd)),
                "unit": difference_unit(quantity),
                "closed_percent": 100.0 * (1.0 - after / before) if before > 0.0 else np.nan,
                "before_sd": float(np.sqrt(g.chi2_before / g.points)),
                "after_sd": float(np.sqrt(g.chi2_after / g.points)),
            }
        )
    frame = pd.DataFrame(rows)
    if frame["tells"].isna().all():
        frame = frame.drop(columns="tells")
    added = bool(found.verdict.effects)
    return frame if added else frame.drop(columns=["rms_after", "closed_percent", "after_sd"])


TABLE = Table(
    place=500,
    make=gap_table,
    title="Errors before and after",
    note="Root mean square of simulated minus measured, before and after the effects of "
    "the verdict were added. Whitened: divided by the standard deviation of the noise, with its "
    "correlation removed; 1 is noise alone. Held-out signals were not fitted. "
    "A held-out signal can tell whether an effect is real if the effect changes it by more than "
    "its noise and its uncertain apparatus.",
    headings={
        "tells": "can tell",
        "rms_before": "rms before",
        "rms_after": "rms after",
        "noise_sd": "sd of the noise",
        "closed_percent": "reduction [%]",
        "before_sd": "whitened rms before",
        "after_sd": "whitened rms after",
    },
    group_by="role",
)
