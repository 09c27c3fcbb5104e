"""Stability of a diagnosis: tables and figure, and a section of the report."""

from pyrofit.show.page import page_of_step
from pyrofit.steps.stability.figures import FIGURES
from pyrofit.steps.stability.record import write_gathered
from pyrofit.steps.stability.sentences import sentences
from pyrofit.steps.stability.tables import TABLES

PAGE = page_of_step(
    "stability",
    heading="Stability of the diagnosis",
    text="How often data changed by a small part of their noise lead to the same effects.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
    finish=write_gathered,
)
