"""Next steps after a run, in sentences for the first screen."""

from collections.abc import Iterator
from itertools import islice

from pyrofit.analysis.answer import one_each
from pyrofit.config import Study
from pyrofit.model.parameters import Parameter
from pyrofit.results.goodness import ONE_RATE
from pyrofit.show.facts import Facts
from pyrofit.show.goodness import next_step, of_one_rate
from pyrofit.show.names import STAGES, all_scored
from pyrofit.show.subjects.answer.predicted import predictions_of, worse_predicted
from pyrofit.show.text import listed


def is_physical(parameter: Parameter, bound: str) -> bool:
    """Tell whether a limit is one of nature: a share is between 0 and 1.

    >>> is_physical(Parameter(unit="-", lower=0.5, upper=0.99), "upper")
    True
    """
    if parameter.unit != "-":
        return False
    if bound == "lower":
        return parameter.lower == 0.0
    return parameter.upper is not None and 0.95 <= parameter.upper <= 1.0


def next_steps(study: Study, facts: Facts) -> Iterator[str]:
    """Yield the steps, the first first: data, limits, model, further tests, prediction."""
    if facts.suspect:
        yield (
            "Look at the data first: no set tried within the limits reaches them. The likeliest "
            f"cause: {facts.suspect}."
        )
    if facts.water:
        yield facts.water
    if any(found.repeats for found in facts.goodness.values()):
        yield (
            "Leave out the records that differ from their repeats, or explain them, and run again. "
            "The section on identifiability tells how they differ."
        )
    ours = one_each(study, facts.estimates)
    bound = {e.name: is_physical(study.parameters[e.name], e.bound) for e in ours if e.bound}
    if wider := [name for name, physical in bound.items() if not physical]:
        yield (
            f"Widen the limits of {listed(wider)} if the material allows it; else look for the "
            "effect that the model lacks."
        )
    if none := [e.name for e in ours if e.bound == "lower" and bound[e.name]]:
        yield (
            f"{listed(none)}: the data show a share of 0, or records that end below 0. Hold it by "
            "`fixed: 0`, or correct the zero of the records."
        )
    if ends := [name for name, physical in bound.items() if physical and name not in none]:
        yield (
            f"{listed(ends)}: no material goes much beyond this limit. The flux, the heat transfer "
            "or the model is not that of the test."
        )
    yield from facts.offers
    missed = [stage for stage, found in facts.goodness.items() if not found.describes]
    for stage in missed[1:] if facts.offers else missed:
        said, command = next_step(study, stage, facts.goodness[stage])
        by = f" ({command})" if command else ""
        yield f"{STAGES[stage].capitalize()}: {_lower(said)}{by}."
    yield from islice(of_one_rate([e.name for e in ours if e.grade == ONE_RATE]), 1, None)
    loose = [e.name for e in ours if e.grade in ("weakly determined", "undetermined")]
    if loose and not missed:
        yield (
            f"To determine {listed(loose)}, plan a test: the step worth tells which one helps most "
            "(pyrofit run STUDY worth)."
        )
    yield advice(study, facts)


def _lower(text: str) -> str:
    return text[0].lower() + text[1:]


def advice(study: Study, facts: Facts) -> str:
    """Say which set to predict with, and how large the errors were at held-out tests."""
    text = "To predict, use all estimates together (pyrofit export fds STUDY writes them)."
    if facts.ensemble:
        text = (
            f"To predict, use the ensemble of {facts.ensemble} sets (posterior/ensemble.csv): its "
            "bands show the uncertainty. If you need one set, use the estimates."
        )
    if not facts.goodness["imp"].describes:
        text += " The model misses its tests: expect errors of that size or larger."
    return f"{text} {_held_out(facts)}"


def _held_out(facts: Facts) -> str:
    mine = predictions_of(facts)
    if not mine:
        return "No test was held out, so the prediction of other tests is untested."
    text = f"At held-out tests the estimates predict {all_scored(mine)}."
    if worse_predicted(facts):
        text += (
            " Find first why they are worse than the fit: an effect that the model lacks, or "
            "another description of these tests."
        )
    return text
