"""The summary of a report in three items."""

from collections.abc import Sequence

from pyrofit.analysis.estimates import by_grade
from pyrofit.analysis.scores import Score
from pyrofit.analysis.uses import FITTED, PUBLISHED, fitted_experiments, title_of
from pyrofit.config import Study
from pyrofit.show.answer.advice import advice
from pyrofit.show.facts import Facts
from pyrofit.show.names import all_scored, named
from pyrofit.show.text import listed, several, span

_LEAST = 0.7
"""Chi-square per point below which independent noise is unlikely."""
_MOST_NAMES = 4
"""Experiments that a sentence names."""


def summary(study: Study, facts: Facts) -> list[str]:
    """Return three items: the fit, the set for predictions, and the determined parameters."""
    return [_fit(study, facts), advice(study, facts), _determined(facts)]


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
    chi2 = [found.per_point for found in facts.misfits if found.stage == "imp"]
    return (
        f"{text}. The best fit of all has a chi-square of {span(chi2)} per point; noise alone "
        f"gives 1.{_lasting(chi2)}"
    )


def _lasting(chi2: Sequence[float]) -> str:
    """Say what a chi-square well below 1 means."""
    if min(chi2) >= _LEAST:
        return ""
    return (
        " Below that, the noise includes a lasting error or scatter between repeats, which may "
        "hide misfit: look at the residuals."
    )


def _ours(facts: Facts) -> list[Score]:
    """Return the scores of our sets; none without validation."""
    return [score for score in facts.scores if score.found_by != PUBLISHED]


def _determined(facts: Facts) -> str:
    known = facts.estimates
    groups = by_grade(known)
    sure = groups.pop("determined", [])
    text = f"The data determine {len(sure)} of {several(len(known), 'parameter')} (95 % interval "
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
