"""Draws from the posterior: tables and figures, and a section of the report."""

from pyrofit.show.page import page_of_step
from pyrofit.steps.posterior.figures import FIGURES
from pyrofit.steps.posterior.sentences import sentences
from pyrofit.steps.posterior.tables import TABLES

PAGE = page_of_step(
    "posterior",
    heading="Predictions with bands",
    text="Parameters are drawn from their posterior distribution; every experiment is predicted "
    "with the draws.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
)
