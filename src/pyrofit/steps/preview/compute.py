"""Data against limits: sets within the limits, their band, data outside, and likely causes."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.estimate.targets import Measurements
from pyrofit.logs import Tell
from pyrofit.results.files import Results, write_csv
from pyrofit.results.recorded import load
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.preview import record
from pyrofit.steps.preview.causes import is_far, likely, suspects
from pyrofit.steps.preview.drying import held_up_of
from pyrofit.steps.preview.fit import nearest
from pyrofit.steps.preview.reach import (
    NOISE,
    OUTSIDE,
    Channel,
    Curves,
    Reached,
    RecordedCases,
    all_reached,
    case_of,
    peak_off,
    simulate_all,
)
from pyrofit.steps.preview.sets import Sets, draw_sets

SETS = 300
"""Sets within the limits."""
OF_REPEATS = 32
"""Sets that a further repeat of a test is simulated with first."""
MANY = 10
"""Number of tests above which no second descent follows one that comes near all records."""
BASES = 8
"""Sets about which each parameter is moved from limit to limit."""
MOSTLY = 0.5
"""Share of a record outside from which on all of it may be wrong by a factor of ten."""
FAR_PEAK = 3.0
"""The same of its peak, beyond those of the sets: a band from zero on holds all that is small."""
FELT = 0.005
"""Least change of a signal that counts, over its range."""


GAP = 10
"""Points between two windows on one side that are told as one."""


@dataclass(frozen=True, eq=False)
class Preview:
    """The findings, and the band of every record."""

    found: record.Preview
    bands: pd.DataFrame


def run(study: Study, results: Results, tell: Tell, processes: int) -> None:
    """Compare the data of a study with all that its limits allow; write ``preview``.

    Parameters
    ----------
    study, results
        A study whose measurements are prepared.
    tell
        Is told how many sets are simulated.
    processes
        Without effect: all sets of an experiment are simulated in one call.

    Raises
    ------
    DataError
        A measurement is missing.
    """
    tell(f"preview: {SETS} sets within the limits")
    made = preview(study, load(study, results))
    write_csv(results.of_step("preview", record.BANDS), made.bands)
    record.write(results, made.found)


def preview(study: Study, measurements: Measurements, count: int = SETS) -> Preview:
    """Return what the data are beside all that the limits allow.

    Parameters
    ----------
    study
        The study.
    measurements
        Measured series by (experiment, signal), SI units.
    count
        Number of sets.
    """
    every = case_of(study, measurements)
    sets = draw_sets(study, study.parameters, count)
    simulated = all_simulated(study, every, sets)
    unfinished = _unfinished(simulated)
    case = every.of([name for name in every.experiments if unfinished.get(name, 0) < count])
    curves = {channel: simulated[channel] for channel in case.frames}
    reached = all_reached(case, curves)
    alone = case.without_repeats({c: one.outside for c, one in reached.items()})
    shown = {channel: reached[channel] for channel in alone.frames}
    many = len(alone.experiments) > MANY
    before = nearest(study, alone, sets, curves, lambda left: many and not suspects(shown, left))
    left = before.left
    suspected = suspects(shown, left)
    mostly = [
        channel
        for channel, one in reached.items()
        if one.share_outside > MOSTLY or peak_off(one.value, curves[channel]) > FAR_PEAK
    ]
    causes = likely(study, alone, sets, suspected, mostly, before) if suspected else []
    found = record.Preview(
        sets=count,
        unfinished=unfinished,
        windows=[w for c, one in reached.items() for w in windows(case, c, one)],
        nearest=[record.NearestSet(experiment=e, signal=s, left=d) for (e, s), d in left.items()],
        far=is_far(left),
        causes=causes,
        unmoved=unmoved(study, alone, sets.first(BASES), reached),
        held_up=[
            record.HeldUp(experiment=test, signal=signal, temperature_K=at)
            for test, signal, at in held_up_of(study, measurements)
        ],
    )
    return Preview(found, _bands(case, curves, reached))


def all_simulated(study: Study, case: RecordedCases, sets: Sets) -> Curves:
    """Return the curves of all sets; of a further repeat within the band those of a few sets.

    The band of all sets holds that of a few. So a repeat that lies outside for a few, or whose
    runs do not finish, is simulated with all.

    Parameters
    ----------
    study, case, sets
        The study, all its records, and all sets.
    """
    first = case.without_repeats({})
    further = case.of(case.experiments.keys() - first.experiments.keys())
    few = simulate_all(study, further, sets.first(OF_REPEATS))
    outside = {name for (name, _), one in all_reached(further, few).items() if one.outside > 0.0}
    again = further.of(outside | _unfinished(few).keys())
    found = {**few, **simulate_all(study, first, sets), **simulate_all(study, again, sets)}
    return {channel: found[channel] for channel in case.frames}


def _unfinished(curves: Curves) -> dict[str, int]:
    failed = {e: int(np.count_nonzero(np.isnan(c).any(axis=1))) for (e, _), c in curves.items()}
    return {name: count for name, count in failed.items() if count}


def abscissa(case: RecordedCases, channel: Channel) -> FloatArray:
    """Return the temperatures [K] of a record against them, else its times [s]."""
    name, signal = channel
    heated = case.experiments[name].quantity(signal).against_temperature
    return case.frames[channel]["temperature_K" if heated else "time_s"].to_numpy(float)


def windows(case: RecordedCases, channel: Channel, one: Reached) -> list[record.Window]:
    """Return the windows in which a record lies outside; none if it does so by little.

    Parameters
    ----------
    case, channel
        The records, and experiment and signal of one.
    one
        This record beside the band.
    """
    if one.outside <= OUTSIDE:
        return []
    at = abscissa(case, channel)
    distance = np.maximum(one.value - one.upper, one.lower - one.value)
    found = []
    for first, last in _stretches(np.sign(one.beyond)):
        largest = float(distance[first : last + 1].max())
        found.append(
            record.Window(
                experiment=channel[0],
                signal=channel[1],
                begins=float(at[first]),
                ends=float(at[last]),
                above=bool(one.beyond[first] > 0.0),
                largest=largest,
                share=largest / one.scale,
            )
        )
    return found


def _stretches(side: FloatArray) -> list[tuple[int, int]]:
    """Return first and last positions of points on one side; small gaps between them are bridged.

    >>> _stretches(np.array([0.0, 1.0, 1.0, 0.0, 1.0, -1.0]))
    [(1, 4), (5, 5)]
    """
    found: list[tuple[int, int]] = []
    for i in np.flatnonzero(side):
        if found and side[i] == side[found[-1][1]] and i - found[-1][1] <= GAP:
            found[-1] = found[-1][0], int(i)
        else:
            found.append((int(i), int(i)))
    return found


def unmoved(
    study: Study, case: RecordedCases, sets: Sets, reached: Mapping[Channel, Reached]
) -> list[str]:
    """Return the parameters that move no signal by more than its noise, from limit to limit.

    Such a parameter cannot be estimated from these data.

    Parameters
    ----------
    study, case
        The study and its records.
    sets
        A few sets about which each parameter is moved.
    reached
        The records beside the band.
    """
    found = []
    for name in sets.names if case.frames else ():
        ends = sets.at_ends(name)
        if not any(_moves(study, case.of([test]), ends, reached) for test in case.experiments):
            found.append(name)
    return found


def _moves(
    study: Study, case: RecordedCases, ends: Sets, reached: Mapping[Channel, Reached]
) -> bool:
    """Tell whether a parameter moves a signal by more than its noise."""
    for channel, both in simulate_all(study, case, ends).items():
        lower, upper = np.split(both, 2)
        noise = case.frames[channel][NOISE].to_numpy(float)
        if np.any(np.abs(upper - lower) > np.maximum(noise, FELT * reached[channel].scale)):
            return True
    return False


def _bands(case: RecordedCases, curves: Curves, reached: Mapping[Channel, Reached]) -> pd.DataFrame:
    """Return measured values and bands, SI units: all sets, and the middle half of them."""
    parts = []
    for channel, one in reached.items():
        finite = curves[channel][np.isfinite(curves[channel]).all(axis=1)]
        quarters = np.quantile(finite, [0.25, 0.75], axis=0)
        columns = {"value": one.value, "lower": one.lower, "upper": one.upper}
        middle = {"lower_quarter": quarters[0], "upper_quarter": quarters[1]}
        about = {"experiment": channel[0], "signal": channel[1], "at": abscissa(case, channel)}
        parts.append(pd.DataFrame({**about, **columns, **middle}))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=list(COLUMNS))


COLUMNS = (
    *("experiment", "signal", "at", "value", "lower", "upper"),
    *("lower_quarter", "upper_quarter"),
)
"""Columns of the table of bands."""
