"""Which parameters the data determine."""

from pyrofit.show.identification.sentences import sentences
from pyrofit.show.section import section_of

IDENTIFICATION = section_of(
    __name__,
    __path__,
    anchor="identification",
    heading="What the data determine",
    text="Optimum and curvature of the likelihood, from the noise of the signals.",
    sentences=sentences,
)
