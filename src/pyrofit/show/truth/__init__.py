"""Estimates beside a known truth."""

from pyrofit.show.section import section_of
from pyrofit.show.truth.sentences import sentences

TRUTH = section_of(
    __name__,
    __path__,
    anchor="truth",
    heading="Truth and estimate",
    text="The data are computed from known parameter values.",
    sentences=sentences,
)
