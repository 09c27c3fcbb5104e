"""Fig. 3: the fitted rates."""

from pyrofit.analysis.uses import fitted_experiments, predicted_signals
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.curves import compare_curves
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.verdicts import verdict_on


def fig3(study: Study, results: Results) -> Canvas:
    """Fig. 3: mass loss rate at the fitted experiment, target and best set of each cost."""
    return compare_curves(study, results, _pairs(study))


def _pairs(study: Study) -> list[tuple[str, str]]:
    """Return the predicted rates of fitted experiments."""
    fitted = fitted_experiments(study)
    return [pair for pair in predicted_signals(study, relative=True) if pair[0] in fitted]


FIGURE = Figure(
    place=5,
    applies=lambda study: bool(_pairs(study)),
    make=fig3,
    verdict=lambda study, facts: verdict_on(study, facts, "imp", _pairs(study)),
    title="Fitted rates",
    paper="Figure 3",
    caption="Mass loss rate or heat release rate of the fitted experiments. Grey area: the "
    "data with their uncertainty. Orange: the estimates. In other colours, if any: the best "
    "set that SCE-UA found for each cost function. Thin grey curves with markers: sets of the "
    "literature, simulated by our solver. Curves on top of each other mean that the choice of "
    "the cost function makes no difference here. No set explains long stretches outside the "
    "grey area.",
)
