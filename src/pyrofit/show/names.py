"""Names and titles as they are shown."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pyrofit.analysis.estimates import Estimated
from pyrofit.analysis.scores import Score, by_signal
from pyrofit.config import Study
from pyrofit.results.goodness import AS_DESCRIBED, ONE_RATE
from pyrofit.show.text import listed, span
from pyrofit.show.units import difference, difference_unit


def titled(study: Study, title: str, place: str) -> str:
    """Return a title; where a study has published values, with the place of their like."""
    return f"{title} ({place} of Lauer et al., 2020)" if place and study.published else title


def data_name(study: Study, series: Iterable[tuple[str, str]]) -> str:
    """Return the kind of data of (experiment, signal) pairs: 'measured', or 'synthetic data'."""
    computed = {study.is_computed(*pair) for pair in series}
    if computed == {True, False}:
        return "measured or synthetic data"
    return "synthetic data" if True in computed else "measured"


STAGES = {"kinetics": "kinetics", "imp": "inverse modelling"}
"""The stages in words."""


def flag(estimate: Estimated) -> str:
    """Return the flag of a parameter that the data do not determine, empty for one they do."""
    graded = estimate.grade not in ("determined", AS_DESCRIBED, "at a limit")
    by = "" if estimate.grade == ONE_RATE else " by the data"
    words = [f"{estimate.grade}{by}"] if graded else []
    words += [f"estimate at its {estimate.bound} limit"] if estimate.bound else []
    return "; ".join(words)


def verdict_of(estimate: Estimated) -> str:
    """Return the verdict on an estimate; a limit that it has reached comes first."""
    if not estimate.bound:
        return estimate.grade
    loose = "; undetermined" if estimate.grade == "undetermined" else ""
    return f"at its {estimate.bound} limit{loose}"


def named_estimate(estimate: Estimated) -> str:
    """Return a parameter with the width of its interval and the bound that it is at."""
    bound = f", {estimate.bound} limit" if estimate.bound else ""
    return f"{estimate.name} ({span([100.0 * estimate.width])} %{bound})"


def signal_words(study: Study, experiment: str, signal: str) -> str:
    """Return a signal in words."""
    return study.experiments[experiment].words(signal)


def costs_of(rows: Sequence[Mapping[Any, Any]]) -> str:
    """List the cost functions of some rows."""
    return listed([str(row["cost_function"]) for row in rows])


def scored(found: Sequence[Score]) -> str:
    """Write the range of scores of one signal, with their measure."""
    quantity = found[0].quantity
    if quantity.relative:
        return f"CV(RMSE) {span([score.value for score in found])}"
    values = [float(difference(quantity, score.value)) for score in found]
    return f"RMSE {span(values)} {difference_unit(quantity)}".removesuffix(" –")


def all_scored(found: Iterable[Score]) -> str:
    """Write the range of scores of each signal."""
    groups = by_signal(found).items()
    return listed([f"the {signal} with {scored(scores)}" for signal, scores in groups])


def places_of(found: Iterable[Score]) -> str:
    """List the experiments of some scores."""
    return listed(list(dict.fromkeys(score.experiment for score in found)))
