"""Which parameters the data determine."""

from pyrofit.show.page import page_of_folder
from pyrofit.show.subjects.identification.sentences import sentences

PAGE = page_of_folder(
    __name__,
    __path__,
    place=40,
    heading="What the data determine",
    text="Optimum and curvature of the likelihood, from the noise of the signals.",
    sentences=sentences,
)
