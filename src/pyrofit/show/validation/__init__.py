"""Fitted tests, and predictions of data that were not fitted."""

from pyrofit.show.section import section_of
from pyrofit.show.validation.sentences import sentences

VALIDATION = section_of(
    __name__,
    __path__,
    anchor="validation",
    heading="Fitted and predicted tests",
    text="The estimates beside the tests they were fitted to, and at others.",
    sentences=sentences,
)
