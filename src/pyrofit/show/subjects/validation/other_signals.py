"""Predicted signals that are no rates: temperatures, masses."""

from pyrofit.analysis.uses import predicted_signals
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.curves import compare_curves
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.verdicts import verdict_on


def other_signals(study: Study, results: Results) -> Canvas:
    """Draw temperatures and other signals over time at all predicted experiments."""
    pairs = predicted_signals(study, relative=False)
    return compare_curves(study, results, pairs)


FIGURE = Figure(
    place=30,
    applies=lambda study: bool(predicted_signals(study, relative=False)),
    make=other_signals,
    verdict=lambda study, facts: verdict_on(
        study, facts, "imp", predicted_signals(study, relative=False)
    ),
    title="Temperatures and other signals",
    caption="Signals of the predicted experiments that are no rates, such as the back "
    "temperature. Shown are the data with their uncertainty and the predictions of "
    "the same sets. Repeats of a test share a panel, with a prediction for each. A "
    "signal that was not fitted tests whether the parameters have a physical meaning.",
)
