"""The inverse modelling by SCE-UA."""

from pyrofit.show.fit.sentences import sentences
from pyrofit.show.section import section_of

FIT = section_of(
    __name__,
    __path__,
    anchor="fit",
    heading="Fit",
    text="Inverse modelling: parameters from gasification, once per repetition and cost "
    "function, by SCE-UA.",
    sentences=sentences,
)
