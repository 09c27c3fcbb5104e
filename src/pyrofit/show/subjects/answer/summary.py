"""The first screen of a report: three questions, answered."""

from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.parts import Question
from pyrofit.show.subjects.answer.described import described_stages
from pyrofit.show.subjects.answer.next_steps import next_steps
from pyrofit.show.subjects.answer.publish import publishable


def summary(study: Study, facts: Facts) -> list[Question]:
    """Return the questions with their answers; the table of values follows the second one."""
    return [
        Question("Does the model describe the tests?", tuple(described_stages(study, facts))),
        Question("Which values can I publish?", tuple(publishable(study, facts)), table=True),
        Question("What should I do next?", tuple(next_steps(study, facts))),
    ]
