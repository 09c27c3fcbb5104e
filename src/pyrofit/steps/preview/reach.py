"""What sets reach: simulated curves of all sets at the measured points, and the data outside."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.config.expand.programs import externals
from pyrofit.estimate.coarse import point_noise
from pyrofit.estimate.run import Run, alike, asked_together, own_curves
from pyrofit.estimate.targets import Measurements
from pyrofit.experiments import kind_of
from pyrofit.model.experiment import Experiment
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.preview.sets import Sets

Channel = tuple[str, str]
"""Experiment and signal."""

NOISE = "noise"
"""Column of a record with the standard deviation of its noise."""
MOST_POINTS = 200
"""Points of a record that are compared."""
NOISE_SDS = 3.0
"""Standard deviations of the noise that a point may lie beside the band."""
OF_RANGE = 0.03
"""The same as a share of the range: errors of the model and the apparatus."""
OUTSIDE = 0.002
"""Mean distance outside, over the range, from which on it is told. Studies as shipped have 0.0006
at most."""
PEAKS = (0.1, 0.9)
"""Quantiles of the peaks of the sets' curves that a record's peak is set beside."""
OF_BAND = 0.10
"""The same as a share of the width of the band: 300 sets do not reach its edges."""


@dataclass(frozen=True, eq=False)
class RecordedCases:
    """Experiments as they are described, and their records as they were read, SI units."""

    experiments: Mapping[str, Experiment]
    frames: Mapping[Channel, pd.DataFrame]

    def signals(self, name: str) -> list[str]:
        """Return the signals of an experiment."""
        return [signal for experiment, signal in self.frames if experiment == name]

    def without_repeats(self, outside: Mapping[Channel, float]) -> "RecordedCases":
        """Return the case with one repeat of each test: that which lies outside most, or the first.

        ``outside`` is the mean distance of each record outside, over its range.
        """
        tests: dict[str, dict[str, float]] = {}
        for name, experiment in self.experiments.items():
            test = experiment.repeat.test if experiment.repeat else name
            most = max((d for (e, _), d in outside.items() if e == name), default=0.0)
            tests.setdefault(test, {})[name] = most
        return self.of({max(of, key=of.__getitem__) for of in tests.values()})

    def of(self, names: Collection[str]) -> "RecordedCases":
        """Return some experiments and their records alone."""
        return RecordedCases(
            {n: e for n, e in self.experiments.items() if n in names},
            {c: f for c, f in self.frames.items() if c[0] in names},
        )

    def with_experiment(self, name: str, experiment: Experiment) -> "RecordedCases":
        """Return the case with another description of an experiment."""
        return RecordedCases({**self.experiments, name: experiment}, self.frames)

    def with_frame(self, channel: Channel, frame: pd.DataFrame) -> "RecordedCases":
        """Return the case with another record."""
        return RecordedCases(self.experiments, {**self.frames, channel: frame})


Curves = Mapping[Channel, FloatArray]
"""Simulated curves of all sets, shape (sets, points); no numbers where a run did not finish."""


def case_of(study: Study, measurements: Measurements) -> RecordedCases:
    """Return all experiments of a study that pyrofit simulates itself, with thinned records.

    An external program would take too long; its experiments are left out.
    """
    programs = externals(study)
    frames = {
        channel: thinned(frame).assign(**{NOISE: record_noise(study, channel, frame)})
        for channel, frame in measurements.items()
        if channel[0] not in programs
    }
    return RecordedCases({n: e for n, e in study.experiments.items() if n not in programs}, frames)


def thinned(frame: pd.DataFrame) -> pd.DataFrame:
    """Return a record with `MOST_POINTS` points at most, evenly picked."""
    last = len(frame) - 1
    picked = np.unique(np.linspace(0, last, min(last + 1, MOST_POINTS)).round().astype(int))
    return frame.iloc[picked].reset_index(drop=True)


def record_noise(study: Study, channel: Channel, frame: pd.DataFrame) -> float:
    """Return the noise of a record: the scatter of its points, or the stated sd if that is larger.

    Parameters
    ----------
    study
        The study.
    channel
        Experiment and signal.
    frame
        The whole record, as neighbouring points tell the scatter.
    """
    name, signal = channel
    experiment = study.experiments[name]
    quantity = experiment.quantity(signal)
    found = point_noise(frame[quantity.column].to_numpy(float))
    if quantity.uncertainty_column in frame:
        stated = frame[quantity.uncertainty_column].to_numpy(float)
        found = max(found, float(np.median(stated)) / experiment.signals[signal].uncertainty_sds)
    return found


def simulate_all(
    study: Study, case: RecordedCases, sets: Sets, known: tuple[RecordedCases, Curves] | None = None
) -> dict[Channel, FloatArray]:
    """Return the curves of all sets at the points of all records.

    Parameters
    ----------
    study
        The study, for its material.
    case
        Experiments and records.
    sets
        The sets.
    known
        Another case and its curves of the same sets: what is simulated alike is taken from there.
    """
    found: dict[Channel, FloatArray] = {}
    runs: dict[str, Run] = {}
    for name in dict.fromkeys(experiment for experiment, _ in case.frames):
        if known is not None and _alike(case, known[0], name):
            found |= {(name, signal): known[1][name, signal] for signal in case.signals(name)}
        else:
            runs[name] = _run(case, name)
    together: dict[str, dict[str, Run]] = {}
    for name, first in alike(runs).items():
        together.setdefault(first, {})[name] = runs[name]
    for repeats in together.values():
        found |= _simulated(study, sets, repeats)
    return found


def _alike(one: RecordedCases, other: RecordedCases, name: str) -> bool:
    """Tell whether an experiment of two cases has the same curves at the same points."""
    return one.experiments[name] is other.experiments[name] and all(
        np.array_equal(one.frames[name, s][c], other.frames[name, s][c])
        for s in one.signals(name)
        for c in ("time_s", "temperature_K")
        if c in one.frames[name, s]
    )


def _run(case: RecordedCases, name: str) -> Run:
    """Return the simulation of an experiment, asked for the points of its records."""
    experiment = case.experiments[name]
    request = kind_of(experiment).request
    frames = {signal: case.frames[name, signal] for signal in case.signals(name)}
    return Run(
        experiment,
        {
            signal: request(experiment, signal, frame, frame["time_s"].to_numpy(float))
            for signal, frame in frames.items()
        },
    )


def _simulated(study: Study, sets: Sets, runs: Mapping[str, Run]) -> dict[Channel, FloatArray]:
    """Return the curves of runs that one simulation serves."""
    first = next(iter(runs))
    experiment, asked = runs[first].experiment, asked_together(list(runs.values()))
    own = study.serves(first, "kinetics") and study.kinetics is not None
    material = study.material if own else study.material_with(study.imp.kinetics)
    accuracy, simulate = study.accuracy.coarsened(), kind_of(experiment).simulate
    [found] = simulate([experiment], material, sets.values, [asked], accuracy, sets.count)
    curves: dict[Channel, FloatArray] = {}
    for name, run in runs.items():
        own_of = [own_curves(of_set, asked, run.requests) for of_set in found]
        for signal, request in run.requests.items():
            none = np.full(request.time_s.size, np.nan)
            of_sets = [c.signals[signal] if c.status.finished else none for c in own_of]
            curves[name, signal] = np.array(of_sets)
    return curves


@dataclass(frozen=True, eq=False)
class Reached:
    """A record beside the band of all sets, SI units.

    Parameters
    ----------
    value, lower, upper
        Measured values, and the least and the largest simulated one, shape (points,).
    margin
        How far a point may lie beside the band, shape (points,).
    scale
        Range of the record, or the median one of the curves if that is larger.
    nearest
        Root mean square difference of each set over that range, shape (sets,).
    """

    value: FloatArray
    lower: FloatArray
    upper: FloatArray
    margin: FloatArray
    scale: float
    nearest: FloatArray

    @property
    def beyond(self) -> FloatArray:
        """How far each point lies above (+) or below (-) band and margin, shape (points,)."""
        above = np.maximum(self.value - self.upper - self.margin, 0.0)
        below = np.maximum(self.lower - self.margin - self.value, 0.0)
        return np.asarray(above - below)

    @property
    def share_outside(self) -> float:
        """Share of the sum of all |values| that belongs to points beside band and margin."""
        sizes = np.abs(self.value)
        return float(np.sum(sizes[self.beyond != 0.0])) / max(float(np.sum(sizes)), 1e-300)

    @property
    def outside(self) -> float:
        """Mean distance of the points beside band and margin, over the range."""
        return float(np.mean(np.abs(self.beyond))) / self.scale


def all_reached(case: RecordedCases, curves: Curves) -> dict[Channel, Reached]:
    """Return every record of a case beside the band of its curves."""
    found = {}
    for (name, signal), frame in case.frames.items():
        value = frame[case.experiments[name].quantity(signal).column].to_numpy(float)
        noise = frame[NOISE].to_numpy(float)
        found[name, signal] = reached(value, curves[name, signal], noise)
    return found


def reached(value: FloatArray, curves: FloatArray, noise: FloatArray) -> Reached:
    """Return a record beside the band of curves.

    Parameters
    ----------
    value
        Measured values, shape (points,).
    curves
        Shape (sets, points); those that hold no numbers did not finish.
    noise
        Standard deviation of the noise, shape (points,).
    """
    finished = _finished(curves)
    if not len(finished):  # with a correction that no set survives
        none = np.zeros_like(value)
        return Reached(value, value, value, none, 1.0, np.full(len(curves), np.inf))
    lower, upper = finished.min(axis=0), finished.max(axis=0)
    ranges = np.ptp(finished, axis=1)
    scale = max(float(np.ptp(value)), float(np.median(ranges)), 1e-300)
    margin = NOISE_SDS * noise + OF_RANGE * scale + OF_BAND * (upper - lower)
    misfit = np.sqrt(np.mean((curves - value) ** 2, axis=1)) / scale
    nearest = np.where(np.isfinite(misfit), misfit, np.inf)
    return Reached(value, lower, upper, margin, scale, nearest)


def peak_off(value: FloatArray, curves: FloatArray) -> float:
    """Return the factor by which the largest |value| lies beside those of most sets, 1 within.

    The arguments are those of `reached`.
    """
    peaks = np.abs(_finished(curves)).max(axis=1)
    if not peaks.size:
        return 1.0
    peak = max(float(np.abs(value).max()), 1e-300)
    least, most = np.quantile(peaks, PEAKS)
    return max(float(least) / peak, peak / max(float(most), 1e-300), 1.0)


def _finished(curves: FloatArray) -> FloatArray:
    return curves[np.isfinite(curves).all(axis=1)]
