"""What is fitted: signals, their parameters, the values of all others, and where to start."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from pyrofit.api.choices import (
    Key,
    Signals,
    check_parameter,
    complete,
    names_given,
    si_values,
    signals_of,
    used_by,
)
from pyrofit.config import Study, TermSpec, calibration_channels, diagnosed_parameters, kinetics_of
from pyrofit.errors import StudyError
from pyrofit.estimate.problem import Problem
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray

Stage = Literal["kinetics", "imp"]
STAGES: tuple[Stage, ...] = get_args(Stage)


@dataclass(frozen=True, eq=False)
class Task:
    """Signals to fit and their parameters; all other parameters have values in SI units."""

    study: Study
    channels: tuple[TermSpec, ...]
    estimate: tuple[str, ...]
    fixed: Mapping[str, float]

    @property
    def keys(self) -> list[Key]:
        """Pairs of experiment and signal."""
        return [(c.experiment, c.signal) for c in self.channels]


def values_within(
    study: Study, argument: str, given: Mapping[str, float] | None
) -> dict[str, float]:
    """Return SI values of an argument; refuse those outside their limits, up to round-off."""
    values = si_values(study, {} if given is None else given)
    for name, value in values.items():
        parameter = study.parameters[name]
        if parameter.lower is None or parameter.upper is None:
            continue
        own = value / parameter.factor
        near = 1e-9 * (parameter.upper - parameter.lower)
        if not parameter.lower - near <= own <= parameter.upper + near:
            raise StudyError(
                f"{argument}: '{name}' is {own:g} {parameter.unit}, outside its limits "
                f"{parameter.lower:g} to {parameter.upper:g}; give a value inside, or widen "
                "`lower` and `upper` in the study"
            )
    return values


def initial_of(
    study: Study, names: Collection[str], given: Mapping[str, float] | None
) -> dict[str, float]:
    """Return the SI values from which a search of some parameters starts.

    Raises
    ------
    StudyError
        A value is outside its limits, or that of a parameter that is not estimated.
    """
    values = values_within(study, "initial", given)
    for name in values:
        if name not in names:
            raise StudyError(
                f"initial: '{name}' is not estimated here; leave it out, or name it in `estimate`. "
                f"Estimated: {', '.join(names)}"
            )
    return values


def begin_of(problem: Problem, initial: Mapping[str, float]) -> FloatArray:
    """Return where a search starts, SI units: initial values, else the middle of the limits."""
    middle = dict(zip(problem.names, 0.5 * (problem.lower + problem.upper), strict=True))
    return np.array([{**middle, **initial}[name] for name in problem.names])


def task_of(
    study: Study,
    signals: Signals | None,
    estimate: Iterable[str] | None,
    fixed: Mapping[str, float],
    stage: Stage | None,
    given: Collection[Key] = (),
) -> Task:
    """Return the signals to fit and their parameters, checked."""
    channels, names = _default(study, given)
    if stage == "kinetics":
        channels, names = kinetics_of(study).channels, kinetics_of(study).estimate
    elif stage == "imp":
        channels, names = study.imp.channels, study.imp.estimate
    if signals is not None:
        pairs = signals_of(study, signals)
        _refuse_twice("signals", [", ".join(pair) for pair in pairs])
        channels = tuple(TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in pairs)
    experiments = {c.experiment for c in channels}
    if estimate is None:
        shown = used_by(study, experiments)
        names = tuple(name for name in names if name in shown and name not in fixed)
    else:
        names = tuple(
            [estimate] if isinstance(estimate, str) else names_given("estimate", estimate)
        )
        _refuse_twice("estimate", names)
    for name in names:
        check_parameter(study, name)
        if study.parameters[name].lower is None:
            raise StudyError(f"parameter '{name}' has no limits; give `lower` and `upper` to it")
        if name in fixed:
            raise StudyError(f"parameter '{name}' is both fixed and estimated; choose one")
    if not names or not channels:
        raise StudyError("there is nothing to fit; name signals, and parameters to estimate")
    return Task(study, channels, names, complete(study, fixed, experiments, but=names))


def _refuse_twice(key: str, names: Sequence[str]) -> None:
    twice = [name for name in dict.fromkeys(names) if names.count(name) > 1]
    if twice:
        raise StudyError(f"{key}: '{twice[0]}' stands twice; name it once")


def _default(study: Study, given: Collection[Key]) -> tuple[tuple[TermSpec, ...], tuple[str, ...]]:
    """Return the signals that a study fits and the parameters that it estimates.

    Computed signals are left out where others are measured: they are of another sample.
    """
    channels, names = calibration_channels(study), diagnosed_parameters(study)
    pairs = [(c.experiment, c.signal) for c in channels]
    computed = {key for key in pairs if study.is_computed(*key)} - set(given)
    if len(computed) < len(channels):
        channels = tuple(c for c, p in zip(channels, pairs, strict=True) if p not in computed)
    return channels, names


def starting_points(study: Study, problem: Problem, count: int) -> list[FloatArray]:
    """Return the middle of the search range and points spread over it, as fractions of it."""
    from scipy.stats import qmc

    rng = np.random.default_rng(seed_for(study.seed, "api", "starts"))
    size = len(problem.names)
    spread = qmc.LatinHypercube(size, seed=rng).random(max(count - 1, 0))
    return [np.full(size, 0.5), *(0.05 + 0.9 * spread)]
