"""Measured files: whether they are there, their contents, and whether the costs fit them."""

import functools
from collections.abc import Callable, Iterator
from pathlib import Path

import pandas as pd

from pyrofit.analysis.agreement import disagreements
from pyrofit.analysis.copied_records import notes_on_copies
from pyrofit.analysis.differing_repeats import notes_on_repeats
from pyrofit.config import Study, TermSpec
from pyrofit.config.keys.study import IN_MEMORY
from pyrofit.data.csvfile import FileTable, read_table
from pyrofit.data.download import FOLDER_VARIABLE
from pyrofit.data.fetch import locate, store
from pyrofit.data.series import Measurement, read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.data.suspect import suspicions
from pyrofit.errors import CostError, DataError
from pyrofit.estimate.targets import Measurements, term_for
from pyrofit.model.experiment import Experiment
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.signal import Signal
from pyrofit.results.recorded import OfFile

SYNTHETIC = "synthetic"
MACFP = "macfp:"

Read = tuple[pd.DataFrame, OfFile]
"""A series in SI units, and where it comes from."""


def check_measurements(
    study: Study, source: str, macfp: bool = True
) -> dict[tuple[str, str], Read]:
    """Read the measured files and try the costs on them; return the series.

    The workflow does so before it plans anything, as a step that fails loses its earlier results.
    It leaves out the files of the MaCFP data base, whose checksums are known.

    Raises
    ------
    DataError
        A file is missing or breaks a rule.
    CostError
        A cost cannot be computed from its series.

    Both name ``source``, the study's file.
    """
    try:
        series = read_all(study, macfp)
        check_terms(study, {key: frame for key, (frame, _) in series.items()})
    except (CostError, DataError) as error:
        raise type(error)(f"{source}: {error}") from None
    return series


def read_all(study: Study, macfp: bool = True) -> dict[tuple[str, str], Read]:
    """Read every measured series, those that are computed excepted.

    Raises
    ------
    DataError
        With key, file, row and rule, for every file that is missing or breaks a rule.
    """
    series = {}
    read = functools.cache(read_table)  # several signals may share a file
    wrong = _missing(study) if macfp else []
    # One line says it of all files of the data base.
    macfp = macfp and not wrong
    for name, label, signal in _signals(study):
        if signal.file.startswith(MACFP) and not macfp:
            continue
        try:
            frame, about = _read(study.experiments[name], label, read)
            about.notes.extend(disagreements(study, name, label, frame, about.source))
            series[name, label] = frame, about
        except DataError as error:
            # One file may serve several experiments.
            if not any(line.endswith(str(error)) for line in wrong):
                wrong.append(f"{_place(name, label)}: {error}")
    frames = {key: frame for key, (frame, _) in series.items()}
    for key, note in notes_on_repeats(study, frames):
        series[key][1].notes.append(f"{key[0]} {note}")
    sources = {key: about.source for key, (_, about) in series.items()}
    for key, note in notes_on_copies(study, frames, sources):
        series[key][1].notes.append(note)
    if len(wrong) == 1:
        raise DataError(wrong[0])
    if wrong:
        text = "".join(f"\n  {line}" for line in wrong)
        raise DataError(f"{len(wrong)} measured files cannot be used:{text}")
    return series


def check_terms(study: Study, measurements: Measurements) -> None:
    """Check that every cost can be computed from the series that are given.

    Raises
    ------
    CostError
        With the place of the term: its window holds too few points, or its cost does not fit.
    """
    terms: dict[str, tuple[TermSpec, ...]] = {
        f"imp.costs.{cost}": terms for cost, terms in study.imp.costs.items()
    }
    if study.kinetics is not None:
        terms["kinetics.cost"] = study.kinetics.cost
    for place, specs in terms.items():
        for i, spec in enumerate(specs):
            if (spec.experiment, spec.signal) in measurements:
                _check_term(study, f"{place}.{i}", spec, measurements)


def _check_term(study: Study, place: str, spec: TermSpec, measurements: Measurements) -> None:
    try:
        term_for(study, spec, measurements)
    except CostError as error:
        raise CostError(f"{place}, on {_place(spec.experiment, spec.signal)}: {error}") from None


def _place(experiment: str, signal: str) -> str:
    return f"experiments.{experiment}.signals.{signal}"


def _signals(study: Study) -> Iterator[tuple[str, str, Signal]]:
    """Yield experiment, name and description of each signal that is read from a file."""
    for name, experiment in study.experiments.items():
        for label, signal in experiment.signals.items():
            if signal.file != SYNTHETIC:
                yield name, label, signal


def _missing(study: Study) -> list[str]:
    """Say in one line that several files of the MaCFP data base are not there."""
    needed = {
        signal.file.removeprefix(MACFP): _place(name, label)
        for name, label, signal in _signals(study)
        if signal.file.startswith(MACFP)
    }
    folder = store() if needed else Path()
    absent = [name for name in needed if not (folder / name).is_file()]
    if len(absent) < 2:
        return []
    return [
        f"{needed[absent[0]]}: {folder / absent[0]} and {len(absent) - 1} more files of the MaCFP "
        f"data base are not there; get them with `make data`, or set {FOLDER_VARIABLE} to a copy"
    ]


def _read(experiment: Experiment, label: str, read: Callable[[Path], FileTable]) -> Read:
    signal = experiment.signals[label]
    path = _locate(signal.file)
    found: Measurement = read_series(
        SeriesSpec(
            quantity=experiment.quantity(label).name,
            path=path,
            columns=signal.columns,
            units=signal.units,
            uncertainty=signal.uncertainty,
            uncertainty_meaning=signal.uncertainty_meaning,
            sample_mass_kg=signal.sample_mass_kg,
            sample_area_m2=signal.sample_area_m2,
            sign=1 if signal.endothermic == "positive" else -1,
            from_first=signal.relative_to == "first value",
            **_of_rate(experiment),
        ),
        read,
    )
    frame = found.frame
    if signal.until_K is not None:
        frame = frame[frame["temperature_K"] <= signal.until_K]
    if signal.until_s is not None:
        frame = frame[frame["time_s"] <= signal.until_s]
    if len(frame) < 3:
        raise DataError(f"{found.source}: until_K or until_s leaves {len(frame)} points; raise it")
    in_oxygen = isinstance(experiment, HeatedExperiment) and experiment.oxygen != 0.0
    about = OfFile(
        source=signal.file,
        sha256=found.sha256,
        uncertainty=found.uncertainty_meaning,
        notes=[*found.notes, *suspicions(found.quantity, frame, found.in_K, in_oxygen)],
    )
    return frame, about


def _of_rate(experiment: Experiment) -> dict[str, float]:
    """Return the numbers that tell the times, or the temperatures, which files do not have."""
    if not isinstance(experiment, HeatedExperiment):
        return {}
    rate = {"rate_K_s": experiment.heating_rate_K_min / 60.0}
    if experiment.program == "from_time":
        return rate | {"start_K": experiment.start_temperature_K}
    return rate if experiment.program == "from_temperature" else {}


def _locate(file: str) -> Path:
    if file == IN_MEMORY:
        raise DataError(
            "the series is in memory alone; give it as `data` in Python, or write it to a file and "
            "name that"
        )
    return locate(file.removeprefix(MACFP)) if file.startswith(MACFP) else Path(file)
