"""The inverse modelling by SCE-UA."""

from pyrofit.show.page import page_of_folder
from pyrofit.show.subjects.fit.sentences import sentences

PAGE = page_of_folder(
    __name__,
    __path__,
    place=60,
    heading="Searches of SCE-UA",
    text="A study of methods: parameters fitted to the tests of each cost function, once per "
    "repetition, by SCE-UA.",
    sentences=sentences,
    folded=True,
)
