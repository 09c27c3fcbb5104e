"""Noise of the signals, and how the optimum fits them."""

import pandas as pd

from pyrofit.analysis.misfit import misfits
from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.results import identification
from pyrofit.results.files import Results
from pyrofit.show.names import STAGES, signal_words
from pyrofit.show.table import Table


def noise_of_signals(study: Study, results: Results) -> pd.DataFrame:
    """List the noise of every signal in words, and how the optimum fits it."""
    rows = [
        {
            "fit": STAGES[found.stage],
            "experiment": title_of(study, found.experiment),
            "signal": signal_words(study, found.experiment, found.signal),
            "points": found.points,
            "noise": found.words,
            "chi2_per_point": found.per_point,
        }
        for found in misfits(identification.read(study, results))
    ]
    return pd.DataFrame(rows)


TABLE = Table(
    place=50,
    make=noise_of_signals,
    title="Noise of the signals, and how the optimum fits them",
    note="The standard deviation is the stated uncertainty, or else that of the scatter about a "
    "smooth curve. The simulated curve of a slab is subtracted first, if that explains the record "
    "better. Errors of the clock, 0.5 s, and of the solver are added as squares. A series without "
    "a stated uncertainty also has lasting errors of its apparatus. p: probability that white "
    "noise looks as correlated as the whitened scatter. Chi-square per point is near 1 where the "
    "model fits within the noise; whether it does is tested by the goodness of fit.",
    headings={"chi2_per_point": "chi-square per point"},
    group_by="fit",
)
