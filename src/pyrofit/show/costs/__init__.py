"""Cost functions compared."""

from pyrofit.show.costs.sentences import sentences
from pyrofit.show.section import section_of

COSTS = section_of(
    __name__,
    __path__,
    anchor="costs",
    heading="Cost functions compared",
    text="A study of methods: all sets of all optimisers, under all cost functions and on one "
    "metric. None of them is the answer.",
    sentences=sentences,
    folded=True,
)
