"""Results of a sensitivity analysis: indices over time and of costs, in tables and in short."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis.sobol import Indices
from pyrofit.config import Study
from pyrofit.estimate.measures import Measure
from pyrofit.numerics import linear
from pyrofit.results.files import Results, write_csv
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.sensitivity import record
from pyrofit.steps.sensitivity.record import OfCost, OfInput, OfSignal
from pyrofit.steps.sensitivity.sampler import Sampler
from pyrofit.steps.sensitivity.varied import Input

QUIET = 0.05
"""A signal that varies by less, as a share of its largest standard deviation, counts as at rest."""
BAND = (0.05, 0.95)
"""Ends of the band of curves."""
EQUAL = 1e-9
"""Largest difference of indices of costs that differ by a factor."""


@dataclass(frozen=True, eq=False)
class FoundIndices:
    """Results of the analysis: tables of indices and curves, and what the record says of them."""

    curves: pd.DataFrame
    over_time: pd.DataFrame
    of_costs: pd.DataFrame
    signals: list[OfSignal]
    costs: list[OfCost]
    same: list[list[str]]
    """Groups of costs with equal indices."""


def indices_found(
    study: Study, sampler: Sampler, outputs: FloatArray, indices: Indices
) -> FoundIndices:
    """Return the results.

    Parameters
    ----------
    study, sampler
        The study, and its signals, costs and inputs.
    outputs
        Shape (samples, inputs + 2, outputs).
    indices
        Their indices.
    """
    names = [one.name for one in sampler.inputs]
    signals, curves, over_time, first = [], [], [], 0
    for (experiment, signal), time, size in _signals(sampler):
        part = slice(first, first + size)
        first += size
        values = outputs[:, :2, part].reshape(-1, size)
        rest = values.std(axis=0) < QUIET * values.std(axis=0).max()
        frame = _indices(indices, part, names, {"time_s": time}, rest)
        over_time.append(frame.assign(experiment=experiment, signal=signal))
        curves.append(_curve(values, time).assign(experiment=experiment, signal=signal))
        signals.append(_signal(experiment, signal, frame, values, names))
    measures = sampler.scorer.measures[1:]
    frame = _indices(indices, slice(first, None), names, {"cost": [m.name for m in measures]})
    return FoundIndices(
        curves=pd.concat(curves, ignore_index=True),
        over_time=pd.concat(over_time, ignore_index=True),
        of_costs=frame,
        signals=signals,
        costs=[_cost(study, m, frame) for m in measures],
        same=_same(frame),
    )


def write_tables(results: Results, found: FoundIndices) -> None:
    """Write curves, indices over time, and indices of costs."""
    tables = {
        record.CURVES: found.curves,
        record.OVER_TIME: found.over_time,
        record.COSTS: found.of_costs,
    }
    for name, table in tables.items():
        write_csv(results.of_step("sensitivity", name), table)


def _signals(sampler: Sampler) -> list[tuple[tuple[str, str], FloatArray, int]]:
    """Return experiment and signal, times and number of them of each signal."""
    terms = sampler.scorer.problem.cost.terms
    return [
        ((spec.experiment, spec.signal), term.target.time_s[at], len(at))
        for spec, (_, term), at in zip(
            sampler.scorer.measures[0].terms, terms, sampler.at, strict=False
        )
    ]


def _indices(
    found: Indices,
    part: slice,
    names: list[str],
    by: Mapping[str, Any],
    rest: Any = False,
) -> pd.DataFrame:
    """Return a tidy table of indices; no numbers where a signal rests."""
    columns = {key: getattr(found, key)[part] for key in Indices.__annotations__}
    (key, labels), count = next(iter(by.items())), len(names)
    labels = np.asarray(labels)
    frame = pd.DataFrame({key: np.repeat(labels, count), "input": names * len(labels)})
    for column, values in columns.items():
        kept = np.where(np.broadcast_to(rest, labels.shape)[:, None], np.nan, values)
        frame[column] = kept.ravel()
    return frame


def _curve(values: FloatArray, time: FloatArray) -> pd.DataFrame:
    low, high = np.quantile(values, BAND, axis=0)
    mean, sd = values.mean(axis=0), values.std(axis=0)
    return pd.DataFrame({"time_s": time, "mean": mean, "sd": sd, "low": low, "high": high})


def _signal(
    experiment: str, signal: str, frame: pd.DataFrame, values: FloatArray, names: list[str]
) -> OfSignal:
    """Return the largest index of each input over time, and its share of all variance.

    The share is sum_t V(t) total(t) / sum_t V(t) (Lamboni et al. 2011,
    doi 10.1016/j.ress.2010.09.002).
    """
    total = frame.pivot(index="time_s", columns="input", values="total")[names]
    variance = values.var(axis=0)
    counts = total.notna().all(axis=1).to_numpy()
    known = max(variance[counts].sum(), 1e-300)
    shares = linear.product(variance[counts], total[counts].to_numpy()) / known
    largest = total.fillna(0.0).to_numpy()
    times = total.index.to_numpy(float)[largest.argmax(axis=0)]
    return OfSignal(
        experiment=experiment,
        signal=signal,
        total=dict(zip(names, shares.tolist(), strict=True)),
        most=dict(zip(names, largest.max(axis=0).tolist(), strict=True)),
        most_at_s=dict(zip(names, times.tolist(), strict=True)),
    )


def of_input(one: Input) -> OfInput:
    """Return the record of an input, in its unit."""
    return OfInput(
        name=one.name,
        label=one.label,
        kind=one.kind,
        experiment=one.experiment,
        unit=one.unit,
        low=one.low / one.factor,
        high=one.high / one.factor,
        mean=one.mean / one.factor,
        sd=None if one.sd is None else one.sd / one.factor,
        source=one.source,
    )


def _cost(study: Study, measure: Measure, frame: pd.DataFrame) -> OfCost:
    own = frame[frame["cost"] == measure.name].fillna(0.0)
    signals = {(t.experiment, t.signal) for t in measure.terms or study.imp.channels}
    times = {t.options.get("time_s") for t in measure.terms}
    return OfCost(
        name=measure.name,
        words=measure.words,
        own=measure.name in study.imp.costs,
        signals=[list(pair) for pair in sorted(signals)],
        at_s=times.pop() if len(times) == 1 else None,
        first=dict(zip(own["input"], own["first"].tolist(), strict=True)),
        total=dict(zip(own["input"], own["total"].tolist(), strict=True)),
    )


def _same(frame: pd.DataFrame) -> list[list[str]]:
    """Return groups of costs with equal indices; the first of a group is shown."""
    wide = frame.pivot(index="cost", columns="input", values="total").fillna(0.0)
    groups: list[list[str]] = []
    for name in dict.fromkeys(frame["cost"]):
        row = wide.loc[name].to_numpy(float)
        alike = (g for g in groups if np.max(np.abs(wide.loc[g[0]].to_numpy() - row)) < EQUAL)
        group = next(alike, None)
        groups.append([name]) if group is None else group.append(name)
    return [group for group in groups if len(group) > 1]
