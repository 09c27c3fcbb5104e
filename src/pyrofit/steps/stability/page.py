"""Stability of a diagnosis: tables and figure, and a section of the report."""

from pyrofit.show.step_page import StepPage
from pyrofit.steps.stability.figures import FIGURES
from pyrofit.steps.stability.record import write_gathered
from pyrofit.steps.stability.sentences import sentences
from pyrofit.steps.stability.tables import TABLES

PAGE = StepPage(
    folder="stability",
    heading="Stability of the diagnosis",
    text="How often data changed by a small part of their noise lead to the same effects.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
    tables_shown=tuple(TABLES),
    figures_shown=tuple(FIGURES),
    finish=write_gathered,
)
