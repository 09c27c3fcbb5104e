"""Facts that tables, figures and sentences of the sensitivity share."""

from collections.abc import Iterable, Sequence

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.steps.sensitivity import record
from pyrofit.steps.sensitivity.record import OfCost, OfInput, OfSignal, Sensitivity

SEEN = 0.05
"""Total index below which a cost is said not to see a parameter."""
PLAIN = 0.2
"""Total index of a signal at a time from which on it is said to depend on a parameter."""
MOST_SHOWN = 6
"""Inputs that a figure tells apart."""


def shown_costs(found: Sensitivity) -> list[OfCost]:
    """Return the costs to show: of those that differ by a factor, the first."""
    again = {name for group in found.same for name in group[1:]}
    return [cost for cost in found.costs if cost.name not in again]


def short(found: Sensitivity, name: str) -> str:
    """Return an input's name as figures have it: without the experiment where there is but one."""
    one = next(one for one in found.inputs if one.name == name)
    several = len({other.experiment for other in found.inputs if other.experiment}) > 1
    if not one.experiment:
        return name
    own = name.removeprefix(f"{one.experiment}_").replace("_", " ")
    return f"{own}, {one.experiment}" if several else own


def names_of_estimated(found: Sensitivity) -> list[str]:
    """Return the names of the estimated parameters."""
    return [one.name for one in found.inputs if one.kind == "estimated"]


def others(found: Sensitivity) -> list[str]:
    """Return the names of the inputs that vary without being estimated."""
    return [one.name for one in found.inputs if one.kind != "estimated"]


def largest_inputs(found: Sensitivity, names: Sequence[str], count: int = MOST_SHOWN) -> list[str]:
    """Return those inputs with the largest index at some time, in their order."""
    most = {name: max(s.most[name] for s in found.signals) for name in names}
    first = sorted(names, key=lambda name: -most[name])[:count]
    return [name for name in names if name in first]


def over_time(results: Results, signal: OfSignal) -> pd.DataFrame:
    """Return the indices of a signal over time."""
    return _of(read_csv(results.of_step("sensitivity", record.OVER_TIME)), signal)


def mean_curve(results: Results, signal: OfSignal) -> pd.DataFrame:
    """Return mean and band of a signal over the sample."""
    return _of(read_csv(results.of_step("sensitivity", record.CURVES)), signal)


def _of(frame: pd.DataFrame, signal: OfSignal) -> pd.DataFrame:
    mine = (frame["experiment"] == signal.experiment) & (frame["signal"] == signal.signal)
    return frame[mine]


def words(study: Study, signal: Iterable[str]) -> str:
    """Return a signal's name in words, with the experiment."""
    experiment, name = signal
    return f"{study.experiments[experiment].words(name)} of {experiment}"


def distribution(one: OfInput) -> str:
    """Return how an input varies."""
    if one.sd is None:
        return f"uniform, {one.low:.4g} to {one.high:.4g}"
    return f"normal, {one.mean:.4g} ± {one.sd:.2g}"
