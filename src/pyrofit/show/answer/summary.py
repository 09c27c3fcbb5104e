"""The summary of a report in three items."""

from pyrofit.analysis.estimates import by_grade
from pyrofit.analysis.scores import Score
from pyrofit.analysis.uses import FITTED, PUBLISHED, fitted_experiments, title_of
from pyrofit.config import Study
from pyrofit.show.answer.advice import advice
from pyrofit.show.facts import Facts
from pyrofit.show.goodness import goodness_sentences
from pyrofit.show.names import STAGES, all_scored, named
from pyrofit.show.text import listed, several

_MOST_NAMES = 4
"""Experiments that a sentence names."""


def summary(study: Study, facts: Facts) -> list[str]:
    """Return the items: whether the models describe the tests, values, predictions, the fit."""
    return [*_described(study, facts), _determined(facts), advice(study, facts), _fit(study, facts)]


def _described(study: Study, facts: Facts) -> list[str]:
    """Say for each stage whether its model describes the tests, where not, and what to do."""
    return [
        " ".join(goodness_sentences(study, stage, STAGES[stage], found))
        for stage, found in facts.goodness.items()
    ]


def _fit(study: Study, facts: Facts) -> str:
    used = fitted_experiments(study)
    names = [title_of(study, name) for name in study.experiments if name in used]
    where = listed(names) if len(names) <= _MOST_NAMES else several(len(names), "experiment")
    fitted = [score for score in _ours(facts) if score.use == FITTED]
    text = (
        f"With {several(len(study.imp.estimate), 'parameter')} fitted to {where} by "
        f"{several(len(study.imp.costs), 'cost function')}, the best sets reproduce "
    )
    text += all_scored(fitted) if fitted else "the fitted data"
    return f"{text}."


def _ours(facts: Facts) -> list[Score]:
    """Return the scores of our sets; none without validation."""
    return [score for score in facts.scores if score.found_by != PUBLISHED]


def _determined(facts: Facts) -> str:
    known = facts.estimates
    groups = by_grade(known)
    sure = groups.pop("determined", [])
    if "apparent value" in groups and not sure:
        text = "No value can be published as a property of the material from this model"
    else:
        text = (
            f"The data determine {len(sure)} of {several(len(known), 'parameter')} (95 % interval "
        )
        text += "narrower than 20 % of the search range)"
    parts = [f"{grade}: {listed([named(e) for e in found])}" for grade, found in groups.items()]
    text = f"{text}; {'; '.join(parts)}." if parts else f"{text}."
    loose = [e.name for e in known if e.grade in ("weakly determined", "undetermined")]
    if loose:
        text += f" Do not quote {listed(loose)} alone: other values fit as well."
    return text + _at_limits([e.name for e in known if e.grade == "at a limit"])


def _at_limits(names: list[str]) -> str:
    if not names:
        return ""
    are = "is" if len(names) == 1 else "are"
    return f" {listed(names)} {are} at a limit: the best fit lies outside the limits."
