"""Fig. 4: the predicted rates."""

from pyrofit.analysis.uses import fitted_experiments, predicted_signals
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.curves import compare_curves
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.verdicts import verdict_on


def fig4(study: Study, results: Results) -> Canvas:
    """Fig. 4: mass loss rate at the held-out experiment, measured and predicted."""
    return compare_curves(study, results, _pairs(study))


def _pairs(study: Study) -> list[tuple[str, str]]:
    """Return the predicted rates of experiments that were not fitted."""
    fitted = fitted_experiments(study)
    return [pair for pair in predicted_signals(study, relative=True) if pair[0] not in fitted]


FIGURE = Figure(
    place=10,
    applies=lambda study: bool(_pairs(study)),
    make=fig4,
    verdict=lambda study, facts: verdict_on(study, facts, "imp", _pairs(study)),
    title="Predicted rates",
    paper="Figure 4",
    caption="The same sets at an experiment that was not fitted. Agreement among the simulated "
    "curves is not agreement with the data: compare them with the grey area.",
)
