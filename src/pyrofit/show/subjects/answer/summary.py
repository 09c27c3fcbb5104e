"""The first screen of a report: three questions, answered."""

from collections.abc import Iterator

from pyrofit.config import Study
from pyrofit.results.goodness import LEVEL, Goodness
from pyrofit.show.facts import Facts
from pyrofit.show.goodness import missed_most, verdict_words
from pyrofit.show.names import STAGES
from pyrofit.show.parts import Question
from pyrofit.show.subjects.answer.next_steps import next_steps
from pyrofit.show.subjects.answer.predicted import worse_predicted
from pyrofit.show.subjects.answer.publish import publishable
from pyrofit.show.text import listed, several

NEAR_ONE = (0.5, 1.5)
"""Chi-square per point that is said to be near 1."""


def described_stages(study: Study, facts: Facts) -> Iterator[str]:
    """Yield for each stage its verdict and where it misses most.

    Tests that are predicted worse than the others are fitted follow, and repeats that differ.
    """
    for stage, found in facts.goodness.items():
        text = verdict_words(STAGES[stage], found)
        if not found.describes:
            text += "".join(f" {where}" for where in missed_most(study, found, 1))
        yield text
        yield from _two_numbers(found, facts.chi2_per_point[stage])
    if worse := worse_predicted(facts):
        yield worse
    yield from _repeats(facts)


def _two_numbers(found: Goodness, chi2: float) -> Iterator[str]:
    """Say what each of two numbers is for, where chi-square is near 1 and the fit misses."""
    low, high = NEAR_ONE
    if found.p < LEVEL and low <= chi2 <= high:
        yield (
            f"Chi-square per point, {chi2:.2g}, says only that the residuals are as large as the "
            "noise. The test says that they stay on one side for long, as noise does not. Judge "
            "the model by the test; use chi-square to compare fits of the same tests."
        )


def _repeats(facts: Facts) -> Iterator[str]:
    found = [r for g in facts.goodness.values() for r in g.repeats]
    names = list(dict.fromkeys(r.experiment for r in found))
    if names:
        differ = "differs from its repeats" if len(names) == 1 else "differ from their repeats"
        yield f"{several(len(names), 'record')} {differ}: {listed(names)}."


def summary(study: Study, facts: Facts) -> list[Question]:
    """Return the questions with their answers; the table of values follows the second one."""
    return [
        Question("Does the model describe the tests?", tuple(described_stages(study, facts))),
        Question("Which values can I publish?", tuple(publishable(study, facts)), table=True),
        Question("What should I do next?", tuple(next_steps(study, facts))),
    ]
