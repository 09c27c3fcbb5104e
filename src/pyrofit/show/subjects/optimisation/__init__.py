"""Optimisers compared."""

from pyrofit.analysis.uses import STARTED
from pyrofit.show.page import page_of_folder
from pyrofit.show.subjects.optimisation.sentences import sentences
from pyrofit.show.text import listed

PAGE = page_of_folder(
    __name__,
    __path__,
    place=70,
    heading="Optimisers",
    text=f"A study of methods: SCE-UA, and from random starts on the same costs {listed(STARTED)}.",
    sentences=sentences,
    folded=True,
)
