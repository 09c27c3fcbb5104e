"""Estimates beside a known truth."""

from pyrofit.show.page import page_of_folder
from pyrofit.show.subjects.truth.sentences import sentences

PAGE = page_of_folder(
    __name__,
    __path__,
    place=50,
    heading="Truth and estimate",
    text="The data are computed from known parameter values.",
    sentences=sentences,
)
