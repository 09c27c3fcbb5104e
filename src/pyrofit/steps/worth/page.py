"""Data worth: table and figure, and a section of the report."""

from pyrofit.show.page import page_of_step
from pyrofit.steps.worth.figures import FIGURES
from pyrofit.steps.worth.sentences import sentences
from pyrofit.steps.worth.tables import TABLES

PAGE = page_of_step(
    "worth",
    heading="Next measurements",
    text="By how much each planned test would narrow parameters and predictions.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
)
