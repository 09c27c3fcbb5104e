"""Robustness of the cost functions: table and figure, and a section of the report."""

from pyrofit.show.page import page_of_step
from pyrofit.steps.robustness.figure import FIGURE
from pyrofit.steps.robustness.sentences import sentences
from pyrofit.steps.robustness.table import TABLE

PAGE = page_of_step(
    "robustness",
    heading="Robustness of the cost functions",
    text="Fits of all cost functions to curves of the model itself, with noise and outliers.",
    tables={"table": TABLE},
    figures={"robustness": FIGURE},
    sentences=sentences,
    prefix="",
)
