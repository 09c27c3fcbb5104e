"""Whether the estimates predict held-out tests as well as they describe the fitted ones."""

from pyrofit.analysis.best_predicting import never_fitted, of_answer
from pyrofit.analysis.scores import Score
from pyrofit.analysis.uses import FITTED
from pyrofit.show.facts import Facts
from pyrofit.show.text import listed

WORSE = 2.0
"""Ratio of errors from which a prediction is said to be worse than the fit."""


def predictions_of(facts: Facts) -> list[Score]:
    """Return the scores of the estimates at tests to which nothing was fitted."""
    return of_answer(never_fitted(facts.scores))


def worse_predicted(facts: Facts) -> str:
    """Say which quantities are predicted worse than they are fitted; nothing where none is.

    The largest error at held-out tests is compared with the largest of the fitted data, quantity by
    quantity.
    """
    of_fit = [score for score in of_answer(facts.scores) if score.use == FITTED]
    mine = predictions_of(facts)
    worse = []
    for quantity in dict.fromkeys(score.quantity for score in mine):
        fitted = [score.value for score in of_fit if score.quantity == quantity]
        predicted = [score.value for score in mine if score.quantity == quantity]
        if fitted and max(predicted) > WORSE * max(fitted):
            worse.append(quantity)
    if not worse:
        return ""
    titles = [f"the {quantity.title}" for quantity in worse]
    return (
        f"Held-out tests: the error of {listed(titles)} is more than twice that of the fitted "
        "data. Expect such errors of other tests, too."
    )
