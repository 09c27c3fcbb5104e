"""Errors that several tests share, each as the correction that would undo it."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np

from pyrofit.model.experiment import Experiment
from pyrofit.model.heated import Baseline, HeatedExperiment
from pyrofit.model.slab import SlabExperiment
from pyrofit.quantities.mass import UNEQUAL
from pyrofit.show.text import listed
from pyrofit.steps.preview.changes import (
    Change,
    before_backing,
    part_changed,
    swapped,
    without_baselines,
)
from pyrofit.steps.preview.likely_cause import BASELINE, PLACE, SWAPPED, WEIGHT, LikelyCause
from pyrofit.steps.preview.reach import Channel, RecordedCases


def weights(case: RecordedCases, outside: Collection[str]) -> Iterator[LikelyCause]:
    """Yield that samples described alike have other masses: each then has a density of its own."""
    groups: dict[str, dict[str, float]] = {}
    for name, experiment in case.experiments.items():
        if not isinstance(experiment, SlabExperiment):
            continue
        for signal in case.signals(name):
            if experiment.quantity(signal).name == "mass":
                column = case.frames[name, signal][experiment.quantity(signal).column]
                like = experiment.sample.model_dump_json()
                groups.setdefault(like, {})[name] = float(column.iloc[0])
    for masses in groups.values():
        least, most = min(masses.values()), max(masses.values())
        if 0.0 < UNEQUAL * least <= most and not masses.keys().isdisjoint(outside):
            yield LikelyCause(
                WEIGHT,
                tuple(masses),
                f"samples described alike weigh {least:.3g} to {most:.3g} kg/m². Give each test "
                "and repeat its `sample: {density_factor: ...}`, its mass over the mean one",
                _weighed(masses),
            )


def _weighed(masses: Mapping[str, float]) -> Change:
    """Return the change of the densities to those of the masses, over the median."""
    middle = float(np.median(list(masses.values())))

    def change(case: RecordedCases) -> RecordedCases:
        for name, mass in masses.items():
            case = part_changed(name, "sample", "density_factor", mass / middle)(case)
        return case

    return change


def baselines(case: RecordedCases, outside: Sequence[Channel]) -> Iterator[LikelyCause]:
    """Yield the baseline of an instrument, of all heat flows for which the study gives none."""
    of = [
        (name, signal)
        for name, signal in outside
        if getattr(case.experiments[name], "baseline", None) == Baseline()
        and case.experiments[name].quantity(signal).has_sign
    ]
    if not of:
        return
    names = tuple(dict.fromkeys(name for name, _ in of))
    yield LikelyCause(
        BASELINE,
        names,
        f"the heat flow of {listed(names)} holds a baseline of the instrument. Subtract it, or "
        "give `baseline` two parameters",
        without_baselines(of),
    )


def places(case: RecordedCases, outside: Sequence[Channel]) -> Iterator[LikelyCause]:
    """Yield that thermocouples stood between samples and what is behind them, in all tests."""
    of = [(e, signal) for e, signal in case.frames if _is_behind(case.experiments[e], signal)]
    if not set(of) & set(outside):
        return
    names = tuple(dict.fromkeys(name for name, _ in of))
    behind = case.experiments[of[0][0]].quantity(of[0][1])
    yield LikelyCause(
        PLACE,
        names,
        f"the {behind.title} of {listed(names)} is that between the sample and the backing. Its "
        f"quantity is then {behind.before_backing}, with the number of layers of the sample as "
        "`layer`",
        before_backing(of),
    )


def _is_behind(experiment: Experiment, signal: str) -> bool:
    """Tell whether a signal is taken as the temperature behind a backing."""
    if not isinstance(experiment, SlabExperiment) or not experiment.sample.backing:
        return False
    return experiment.quantity(signal).before_backing != ""


def swaps(case: RecordedCases, names: Sequence[str]) -> Iterator[LikelyCause]:
    """Yield that the files of two tests are swapped, one of them among those named."""
    for one, other in combinations(case.experiments, 2):
        if one not in names and other not in names:
            continue
        if not all(_has_own_course(case.experiments[name]) for name in (one, other)):
            continue
        shared = [s for s in case.signals(one) if s in case.signals(other)]
        if not shared or case.experiments[one].kind != case.experiments[other].kind:
            continue
        for signals in [shared, *([s] for s in shared if len(shared) > 1)]:
            of = (
                ""
                if signals == shared
                else f" of the {case.experiments[one].quantity(signals[0]).title}"
            )
            yield LikelyCause(
                SWAPPED,
                (one, other),
                f"the files{of} of {one} and {other} are swapped",
                swapped(one, other, tuple(signals)),
            )


def _has_own_course(experiment: Experiment) -> bool:
    """Tell whether a record says nothing of the course of its test, so that another may be taken.

    A heated sample that follows the recorded temperature is simulated as its file was recorded.
    """
    return not isinstance(experiment, HeatedExperiment) or experiment.program == "nominal"
