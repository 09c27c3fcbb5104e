"""Kinetics fitted to thermogravimetric analysis."""

from pyrofit.show.page import page_of_folder
from pyrofit.show.subjects.kinetics.sentences import sentences

PAGE = page_of_folder(
    __name__,
    __path__,
    place=20,
    heading="Kinetics",
    text="Reaction rates from thermogravimetric analysis.",
    sentences=sentences,
)
