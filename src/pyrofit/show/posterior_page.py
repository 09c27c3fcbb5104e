"""Draws from the posterior: tables and figures, and a section of the report."""

from pyrofit.show.posterior.figures import FIGURES
from pyrofit.show.posterior.sentences import sentences
from pyrofit.show.posterior.tables import TABLES
from pyrofit.show.step_page import StepPage

PAGE = StepPage(
    folder="posterior",
    heading="Predictions with bands",
    text="Parameters are drawn from their posterior distribution; every experiment is predicted "
    "with the draws.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
    tables_shown=("parameters", "lacking", "bands"),
    figures_shown=tuple(FIGURES),
)
