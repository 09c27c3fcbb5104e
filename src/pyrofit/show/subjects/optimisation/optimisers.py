"""Rates of the optimisers."""

from pyrofit.analysis.uses import SCEUA, STARTED, predicted_sets, predicted_signals
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results.files import Results
from pyrofit.show.curves import compare_curves
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.text import listed


def optimisers(study: Study, results: Results) -> Canvas:
    """Draw the best sets of all optimisers at all predicted experiments."""
    pairs = predicted_signals(study, relative=True)
    sets = [s for s in predicted_sets(study) if s.origin in (SCEUA, *STARTED)]
    return compare_curves(study, results, pairs, sets)


_MARKED = [f"{by.words} ({by.shape})" for by in OPTIMISERS.values()]
FIGURE = Figure(
    place=30,
    applies=lambda study: bool(predicted_signals(study, relative=True)),
    make=optimisers,
    title="Rates of the optimisers",
    caption=f"The best sets of {listed(_MARKED)} beside those of "
    "SCE-UA. A lower cost at the fitted experiment may come with a worse prediction "
    "elsewhere. Then the fitted data do not determine the parameters, or their values "
    "compensate for a missing effect.",
)
