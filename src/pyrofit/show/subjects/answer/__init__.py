"""The answer: estimates, their use, and the summary."""

from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.page import page_of_folder
from pyrofit.show.subjects.answer.next_steps import advice


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the advice as a list of one."""
    return [advice(study, facts)]


PAGE = page_of_folder(
    __name__,
    __path__,
    place=0,
    heading="The answer",
    text="",
    sentences=sentences,
)
