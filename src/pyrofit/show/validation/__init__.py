"""Predictions of data that were not fitted."""

from pyrofit.show.section import section_of
from pyrofit.show.validation.sentences import sentences

VALIDATION = section_of(
    __name__,
    __path__,
    anchor="validation",
    heading="Validation",
    text="The best sets, simulated at experiments and signals they were not fitted to.",
    sentences=sentences,
)
