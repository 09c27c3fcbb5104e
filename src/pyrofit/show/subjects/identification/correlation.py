"""Correlation of the estimates."""

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.results.identification import matrix_of
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.matrix import draw_matrix


def draw_correlations(study: Study, results: Results) -> Canvas:
    """Draw the correlation matrix of the estimates, with its numbers."""
    return draw_matrix(matrix_of(study, results), "correlation [–]")


FIGURE = Figure(
    place=40,
    make=draw_correlations,
    title="Correlation of the estimates",
    caption="Near ±1 the data determine a combination of two parameters and not each of them. A "
    "parameter at a limit is held there; its correlations are shown as 0.",
)
