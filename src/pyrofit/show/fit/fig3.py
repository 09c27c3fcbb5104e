"""Fig. 3: the fitted mass loss rate."""

from matplotlib.figure import Figure as Canvas

from pyrofit.analysis.uses import PUBLISHED, SCEUA
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.curves import compare_curves, fitted_rates
from pyrofit.show.figure import Figure


def fig3(study: Study, results: Results) -> Canvas:
    """Fig. 3: mass loss rate at the fitted experiment, target and best set of each cost."""
    return compare_curves(study, results, fitted_rates(study), (SCEUA, PUBLISHED))


FIGURE = Figure(
    place=10,
    applies=lambda study: bool(fitted_rates(study)),
    make=fig3,
    title="Mass loss rate, fitted",
    paper="Figure 3",
    caption="Mass loss rate of the fitted experiment: the data with their uncertainty (grey "
    "area), and the best set that SCE-UA found for each cost function; thin grey "
    "curves with markers, if any, are our solver's for sets of the literature. Curves on "
    "top of each other mean that the choice of the cost function makes no difference here; "
    "long stretches outside the grey area are what no set explains.",
)
