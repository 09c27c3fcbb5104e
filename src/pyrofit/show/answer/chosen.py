"""The recommended set."""

import pandas as pd

from pyrofit.analysis.distances import distances
from pyrofit.analysis.recommended import Recommended, recommended
from pyrofit.analysis.scores import scores
from pyrofit.analysis.uses import predicted_labels
from pyrofit.config import Study
from pyrofit.results import identification, prediction
from pyrofit.results.files import Results


def chosen_set(study: Study, results: Results) -> Recommended:
    """Return the set to predict with, see `pyrofit.analysis.recommended`."""
    predicted = pd.DataFrame()
    if study.validation.experiments:
        predicted = prediction.scores(study, results, predicted_labels(study))
    known = distances(study, identification.read(study, results))
    return recommended(scores(study, predicted), known)
