"""Correlation of the sets of all repetitions."""

from pyrofit.analysis.rank_correlation import rank_correlation
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.matrix import draw_matrix


def correlation_of_sets(study: Study, results: Results) -> Canvas:
    """Draw how the parameters go together over the repetitions of every cost function."""
    return draw_matrix(rank_correlation(study, results), "rank correlation [–]")


FIGURE = Figure(
    place=60,
    applies=lambda study: study.imp.repetitions > 2,
    make=correlation_of_sets,
    title="Correlation of the sets of all repetitions",
    caption="Spearman's correlation over the repetitions of SCE-UA, ranked within each cost "
    "function. It shows the directions along which the searches end; the likelihood may have other "
    "correlations.",
)
