"""Optimisers compared."""

from pyrofit.show.optimisers.sentences import sentences
from pyrofit.show.section import section_of

OPTIMISERS = section_of(
    __name__,
    __path__,
    anchor="optimisation",
    heading="Optimisers",
    text="SCE-UA, and from random starts on the same costs least squares and CMA-ES.",
    sentences=sentences,
)
