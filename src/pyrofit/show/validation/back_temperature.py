"""Predicted back temperatures."""

from matplotlib.figure import Figure as Canvas

from pyrofit.analysis.uses import PUBLISHED, SCEUA, predicted
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.curves import compare_curves
from pyrofit.show.figure import Figure


def back_temperature(study: Study, results: Results) -> Canvas:
    """Draw the back temperature over time at all predicted experiments."""
    names = predicted(study, "back_temperature")
    return compare_curves(study, results, names, (SCEUA, PUBLISHED), "back_temperature")


FIGURE = Figure(
    place=30,
    applies=lambda study: bool(predicted(study, "back_temperature")),
    make=back_temperature,
    title="Back temperature",
    caption="Temperature of the back of the sample, the data with their uncertainty and "
    "predicted by the same sets. Where it was not fitted, it tests whether the parameters have "
    "a physical meaning.",
)
