"""Activation energy over conversion, found without a model of the reactions."""

from pyrofit.show.page import page_of_folder
from pyrofit.show.subjects.isoconversional.sentences import sentences

PAGE = page_of_folder(
    __name__,
    __path__,
    place=10,
    heading="Activation energy over conversion",
    text="Activation energies of the measured masses, without a model of the reactions.",
    sentences=sentences,
)
