"""Stored sets under all costs: tables and figures, and a section of the report."""

from pyrofit.show.page import page_of_step
from pyrofit.steps.rescore.figures import FIGURES
from pyrofit.steps.rescore.sentences import sentences
from pyrofit.steps.rescore.tables import TABLES

PAGE = page_of_step(
    "rescore",
    heading="Stored sets under other costs",
    text="All searches store every model call. A sample of these sets is scored again under other "
    "costs.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
)
