"""Fig. 3: the fitted rates."""

from pyrofit.analysis.uses import PUBLISHED, SCEUA, fitted_experiments, predicted_signals
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.curves import compare_curves
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure


def fig3(study: Study, results: Results) -> Canvas:
    """Fig. 3: mass loss rate at the fitted experiment, target and best set of each cost."""
    return compare_curves(study, results, _pairs(study), (SCEUA, PUBLISHED))


def _pairs(study: Study) -> list[tuple[str, str]]:
    """Return the predicted rates of fitted experiments."""
    fitted = fitted_experiments(study)
    return [pair for pair in predicted_signals(study, relative=True) if pair[0] in fitted]


FIGURE = Figure(
    place=10,
    applies=lambda study: bool(_pairs(study)),
    make=fig3,
    title="Fitted rates",
    paper="Figure 3",
    caption="Mass loss rate or heat release rate of the fitted experiments. Grey area: the "
    "data with their uncertainty. Coloured: the best set that SCE-UA found for each "
    "cost function. Thin grey curves with markers: sets of the literature, simulated "
    "by our solver. Curves on top of each other mean that the choice of the cost "
    "function makes no difference here. No set explains long stretches outside the "
    "grey area.",
)
