"""Kinetics fitted to thermogravimetric analysis."""

from pyrofit.show.kinetics.sentences import sentences
from pyrofit.show.section import section_of

KINETICS = section_of(
    __name__,
    __path__,
    anchor="kinetics",
    heading="Kinetics",
    text="Reaction rates from thermogravimetric analysis.",
    sentences=sentences,
)
