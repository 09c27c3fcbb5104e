"""What a run has found, in a sentence for the terminal, and where its pages lie."""

import contextlib
from collections.abc import Iterator

import pandas as pd

from pyrofit.analysis.best_predicting import never_fitted, of_answer
from pyrofit.analysis.scores import scores_of_sets
from pyrofit.analysis.uses import predicted_labels
from pyrofit.config import Study
from pyrofit.errors import PyrofitError
from pyrofit.results import diagnosis, goodness, prediction
from pyrofit.results.files import Results
from pyrofit.show.goodness import verdict_words
from pyrofit.show.names import STAGES, all_scored


def ending(study: Study, results: Results, since: float) -> Iterator[str]:
    """Yield the last lines of a run that started at a time: its pages, with what they tell."""
    for name, tell, page in (
        ("Report", headline, results.root / "report.html"),
        ("Diagnosis", verdict_of_diagnosis, results.diagnosis("report.html")),
    ):
        if page.exists():
            if page.stat().st_mtime >= since:
                with contextlib.suppress(PyrofitError):  # a study of kinetics alone has no such set
                    yield tell(study, results)
            yield f"{name}: {page}"


def headline(study: Study, results: Results) -> str:
    """Return whether the models describe the tests, and how well the estimates predict others.

    The latter is of tests that nothing was fitted to.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    stages = ["kinetics", "imp"] if study.kinetics else ["imp"]
    said = [verdict_words(STAGES[stage], goodness.read(results, stage)) for stage in stages]
    predicted = pd.DataFrame()
    if study.validation.experiments:
        predicted = prediction.read_scores(study, results, predicted_labels(study))
    mine = of_answer(never_fitted(scores_of_sets(study, predicted)))
    if mine:
        said.append(f"Held-out tests: the estimates predict {all_scored(mine)}.")
    else:
        said.append("No test was held out.")
    return "\n".join(said)


def verdict_of_diagnosis(study: Study, results: Results) -> str:
    """Return the verdict of the diagnosis in words.

    Raises
    ------
    DataError
        The diagnosis is missing or broken.
    """
    return diagnosis.read(study, results).verdict.words
