"""Optimisers compared."""

from pyrofit.analysis.uses import STARTED
from pyrofit.show.optimisers.sentences import sentences
from pyrofit.show.section import section_of
from pyrofit.show.text import listed

OPTIMISERS = section_of(
    __name__,
    __path__,
    anchor="optimisation",
    heading="Optimisers",
    text=f"A study of methods: SCE-UA, and from random starts on the same costs {listed(STARTED)}.",
    sentences=sentences,
    folded=True,
)
