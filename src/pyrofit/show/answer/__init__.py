"""The answer: estimates, their use, and the summary."""

from pyrofit.config import Study
from pyrofit.show.answer.next_steps import advice
from pyrofit.show.facts import Facts
from pyrofit.show.section import section_of


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the advice as a list of one."""
    return [advice(study, facts)]


ANSWER = section_of(
    __name__,
    __path__,
    anchor="answer",
    heading="The answer",
    text="",
    sentences=sentences,
)
