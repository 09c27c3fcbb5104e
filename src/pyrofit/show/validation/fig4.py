"""Fig. 4: the predicted mass loss rate."""

from matplotlib.figure import Figure as Canvas

from pyrofit.analysis.uses import PUBLISHED, SCEUA
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.curves import compare_curves, held_out_rates
from pyrofit.show.figure import Figure


def fig4(study: Study, results: Results) -> Canvas:
    """Fig. 4: mass loss rate at the held-out experiment, measured and predicted."""
    return compare_curves(study, results, held_out_rates(study), (SCEUA, PUBLISHED))


FIGURE = Figure(
    place=10,
    applies=lambda study: bool(held_out_rates(study)),
    make=fig4,
    title="Mass loss rate, predicted",
    paper="Figure 4",
    caption="The same sets at an experiment that was not fitted. Agreement among the simulated "
    "curves is not agreement with the data: compare them with the grey area.",
)
