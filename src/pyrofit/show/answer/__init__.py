"""The answer: estimates, best sets, advice and summary."""

from pyrofit.show.answer.advice import sentences
from pyrofit.show.section import section_of

ANSWER = section_of(
    __name__,
    __path__,
    anchor="answer",
    heading="The answer",
    text="",
    sentences=sentences,
)
