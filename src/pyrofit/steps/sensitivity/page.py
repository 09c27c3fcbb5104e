"""Sensitivity over time: tables and figures, and a section of the report."""

from pyrofit.show.page import page_of_step
from pyrofit.steps.sensitivity.figures import FIGURES
from pyrofit.steps.sensitivity.sentences import sentences
from pyrofit.steps.sensitivity.tables import TABLES

PAGE = page_of_step(
    "sensitivity",
    heading="Sensitivity of signals and costs",
    text="Variance-based sensitivity: parameters and values of the apparatus vary together, and "
    "the variance of signals and costs is shared out between them.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
)
