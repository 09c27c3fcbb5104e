"""Activation energy over conversion, found without a model of the reactions."""

from pyrofit.show.isoconversional.sentences import sentences
from pyrofit.show.section import section_of

ISOCONVERSIONAL = section_of(
    __name__,
    __path__,
    anchor="isoconversional",
    heading="Activation energy over conversion",
    text="Activation energies of the measured masses, without a model of the reactions.",
    sentences=sentences,
)
