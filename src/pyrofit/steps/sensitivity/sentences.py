"""Sensitivity of signals and costs, with the reasons, in sentences."""

from collections.abc import Iterable

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.text import listed, several
from pyrofit.steps.sensitivity import record
from pyrofit.steps.sensitivity.facts import (
    PLAIN,
    SEEN,
    names_of_estimated,
    over_time,
    short,
    shown_costs,
    words,
)
from pyrofit.steps.sensitivity.record import OfCost, OfSignal, Sensitivity

WITHIN = {
    "limits": "over their limits",
    "near": "over a fifth of their limits about the estimates",
    "intervals": "as the data leave them, about the estimates",
}
BRIEF = 0.04
"""Share of the record below which a time of dependence on one input is not told."""


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on the sensitivity of signals and costs."""
    found = record.read(study, results)
    own = [cost for cost in shown_costs(found) if cost.own]
    single = [cost for cost in shown_costs(found) if cost.at_s is not None]
    return [
        _sample(found),
        *(_leading(study, found, signal, results) for signal in found.signals),
        *_apparatus(study, found),
        *_blind(study, found, own),
        *_elsewhere(study, found, own),
        *(_of_one_time(study, found, cost) for cost in single),
        *_one_number(found, own or shown_costs(found)),
        *_warnings(found),
    ]


def _sample(found: Sensitivity) -> str:
    count = len(names_of_estimated(found))
    return (
        f"{found.runs} runs vary {several(count, 'estimated parameter')} {WITHIN[found.within]}, "
        f"and {several(len(found.inputs) - count, 'other value')} within their uncertainty."
    )


def _leading(study: Study, found: Sensitivity, signal: OfSignal, results: Results) -> str:
    """Say on which input a signal depends most, time by time."""
    table = over_time(results, signal).pivot(index="time_s", columns="input", values="total")
    table = table.dropna()
    said = [
        f"{short(found, name)} from {start:.0f} to {end:.0f} s" for name, start, end in _runs(table)
    ]
    return f"The {words(study, (signal.experiment, signal.signal))} depends most on {listed(said)}."


def _runs(table: pd.DataFrame) -> list[tuple[str, float, float]]:
    """Return the leading input of each part of a record, without very short parts."""
    leading = table.idxmax(axis=1).to_numpy()
    time = table.index.to_numpy(float)
    ends = np.flatnonzero(leading[1:] != leading[:-1])
    starts = np.concatenate([[0], ends + 1])
    parts = zip(starts, np.concatenate([ends, [len(leading) - 1]]), strict=True)
    kept: list[tuple[str, float, float]] = []
    for i, k in parts:
        if time[k] - time[i] < BRIEF * (time[-1] - time[0]):
            continue
        if kept and kept[-1][0] == leading[i]:
            kept[-1] = (kept[-1][0], kept[-1][1], float(time[k]))
        else:
            kept.append((str(leading[i]), float(time[i]), float(time[k])))
    return kept


def _apparatus(study: Study, found: Sensitivity) -> list[str]:
    """Say which part of the variance values of the apparatus take."""
    names = [one.name for one in found.inputs if one.kind != "estimated"]
    if not names:
        return []
    most = max(found.signals, key=lambda s: max(s.total[name] for name in names))
    name = max(names, key=lambda name: most.total[name])
    return [
        f"Of the other values, {short(found, name)} matters most: it takes part in "
        f"{100.0 * most.total[name]:.2g} % of the variance of the "
        f"{words(study, (most.experiment, most.signal))}."
    ]


def _unseen(found: Sensitivity, cost: OfCost) -> list[str]:
    return [name for name in names_of_estimated(found) if cost.total[name] < SEEN]


def _blind(study: Study, found: Sensitivity, costs: Iterable[OfCost]) -> list[str]:
    """Say which parameters the costs of the study do not see, costs that agree together."""
    groups: dict[tuple[str, ...], list[str]] = {}
    for cost in costs:
        groups.setdefault(tuple(_unseen(found, cost)), []).append(cost.name)
    said = []
    for names, of in groups.items():
        verb = "does" if len(of) == 1 else "do"
        said.append(
            f"{listed(of)} {verb} not see {listed(names)} (total index below {SEEN:g})."
            if names
            else f"{listed(of)} {'sees' if len(of) == 1 else 'see'} every estimated parameter."
        )
    return said


def _elsewhere(study: Study, found: Sensitivity, costs: list[OfCost]) -> list[str]:
    """Say which signal at which time shows a parameter that no cost of the study sees."""
    lost = [n for n in names_of_estimated(found) if costs and all(c.total[n] < SEEN for c in costs)]
    said = []
    for name in lost:
        best = max(found.signals, key=lambda s: s.most[name])
        if best.most[name] >= PLAIN:
            said.append(
                f"{name} shows, though: the {words(study, (best.experiment, best.signal))} has a "
                f"total index of {best.most[name]:.2f} at {best.most_at_s[name]:.0f} s."
            )
    nowhere = [n for n in lost if max(s.most[n] for s in found.signals) < PLAIN]
    if nowhere:
        said.append(
            f"No signal depends much on {listed(nowhere)} at any time (total index below "
            f"{PLAIN:g})."
        )
    return said


def _of_one_time(study: Study, found: Sensitivity, cost: OfCost) -> str:
    """Name the parameters that a cost of a single time misses, though its signal shows them."""
    mine = [s for s in found.signals if [s.experiment, s.signal] in cost.signals]
    lost = {
        name: max(mine, key=lambda s: s.most[name])
        for name in _unseen(found, cost)
        if mine and max(s.most[name] for s in mine) >= PLAIN
    }
    about = f"{cost.name} looks at {cost.at_s:.0f} s alone"
    if not lost:
        unseen = _unseen(found, cost)
        end = f"; it does not see {listed(unseen)}" if unseen else ""
        return f"{about}{end}."
    times = [f"{n} at {s.most_at_s[n]:.0f} s ({s.most[n]:.2f})" for n, s in lost.items()]
    return (
        f"{about} and does not see {listed(list(lost))} (total index below {SEEN:g}), though the "
        f"signal that it compares depends on {listed(times)}."
    )


def _one_number(found: Sensitivity, costs: list[OfCost]) -> list[str]:
    """Say which part of a cost's variance is made in combination, which one number leaves open."""
    together = {c.name: 100.0 * min(max(1.0 - sum(c.first.values()), 0.0), 1.0) for c in costs}
    low, high = min(together.values()), max(together.values())
    part = f"{high:.0f} %" if high - low < 1.0 else f"{low:.0f} to {high:.0f} %"
    count = len(names_of_estimated(found))
    return [
        f"A cost adds up the times of its signals to one number, whatever parameter changed them: "
        f"one equation for {several(count, 'parameter')}. {part} of the variance of the costs is "
        "made by inputs in combination; there one parameter makes up for another."
    ]


def _warnings(found: Sensitivity) -> list[str]:
    said = [f"Left out: {reason}" for reason in found.left_out]
    if found.unfinished:
        said.append(
            f"Of {several(found.unfinished, 'point')} of {found.samples} a run did not finish; "
            "other points were drawn in their place."
        )
    return said
