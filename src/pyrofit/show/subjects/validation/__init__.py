"""Fitted tests, and predictions of data that were not fitted."""

from pyrofit.show.page import page_of_folder
from pyrofit.show.subjects.validation.sentences import sentences

PAGE = page_of_folder(
    __name__,
    __path__,
    place=30,
    heading="Fitted and predicted tests",
    text="The estimates beside the tests they were fitted to, and at others.",
    sentences=sentences,
)
