"""Sensitivity over time: tables and figures, and a section of the report."""

from pyrofit.show.step_page import StepPage
from pyrofit.steps.sensitivity.figures import FIGURES
from pyrofit.steps.sensitivity.sentences import sentences
from pyrofit.steps.sensitivity.tables import TABLES

PAGE = StepPage(
    folder="sensitivity",
    heading="Sensitivity of signals and costs",
    text="Variance-based sensitivity: parameters and values of the apparatus vary together, and "
    "the variance of signals and costs is shared out between them.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
    tables_shown=("inputs",),
    figures_shown=("total", "apparatus", "costs"),
)
