"""Data worth: table and figure, and a section of the report."""

from pyrofit.show.step_page import StepPage
from pyrofit.steps.worth.figures import FIGURES
from pyrofit.steps.worth.sentences import sentences
from pyrofit.steps.worth.tables import TABLES

PAGE = StepPage(
    folder="worth",
    heading="Next measurements",
    text="By how much each planned test would narrow parameters and predictions.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
    tables_shown=tuple(TABLES),
    figures_shown=tuple(FIGURES),
)
