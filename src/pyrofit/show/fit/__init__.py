"""The inverse modelling by SCE-UA."""

from pyrofit.show.fit.sentences import sentences
from pyrofit.show.section import section_of

FIT = section_of(
    __name__,
    __path__,
    anchor="fit",
    heading="Searches of SCE-UA",
    text="A study of methods: parameters fitted to the tests of each cost function, once per "
    "repetition, by SCE-UA.",
    sentences=sentences,
    folded=True,
)
