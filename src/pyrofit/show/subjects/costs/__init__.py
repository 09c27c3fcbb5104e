"""Cost functions compared."""

from pyrofit.show.page import page_of_folder
from pyrofit.show.subjects.costs.sentences import sentences

PAGE = page_of_folder(
    __name__,
    __path__,
    place=80,
    heading="Cost functions compared",
    text="A study of methods: all sets of all optimisers, under all cost functions and on one "
    "metric. None of them is the answer.",
    sentences=sentences,
    folded=True,
)
