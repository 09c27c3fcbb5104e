"""A page without a server: the curves of one or two sliders, computed before."""

import base64
import itertools
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pyrofit.api.choices import in_units
from pyrofit.errors import StudyError, suggest
from pyrofit.results.files import write_text
from pyrofit.solver.arrays import FloatArray
from pyrofit_explore.describe import described_study, drawn_points, in_shown_units, middle
from pyrofit_explore.model import ExploredModel
from pyrofit_explore.page import page
from pyrofit_explore.session import Session

MOST_BYTES = 5_000_000
"""Largest page."""
_FOR_CURVES = 4_000_000
_MOST_STEPS = {1: 81, 2: 25}
"""Sets along a slider at most, by the number of sliders."""
_FEWEST_STEPS = 5
_FAILED = 65535
"""Code of a point of a run that did not finish."""


def write_static(session: Session, sliders: Sequence[str], label: str, path: Path) -> None:
    """Write the page of a study with one or two sliders.

    Parameters
    ----------
    session
        The study.
    sliders
        Names of parameters; empty takes the two that move the fitted signals most.
    label
        The set that the page starts from; empty takes the first one of the study, else the middle
        of the limits.
    path
        The file.

    Raises
    ------
    StudyError
        There are more than two sliders, one is no parameter with limits, a set is unknown, or the
        curves do not fit into a page.
    """
    model = session.base
    values = _start(session, label)
    names = [_known(model, name) for name in sliders] or strongest_pair(model, values)
    if len(names) > 2 or len(set(names)) < len(names):
        raise StudyError(f"sliders: {', '.join(names)}; give one or two different parameters")
    text = page(static_content(session, names, values))
    if len(text.encode()) > MOST_BYTES:
        raise StudyError(f"{path}: the page exceeds 5 MB; give one slider by --sliders")
    write_text(path, text)


def static_content(
    session: Session, names: Sequence[str], values: Mapping[str, float]
) -> dict[str, Any]:
    """Return the content of the page: the description, and curves over a grid of the sliders."""
    model, study = session.base, session.study
    told = described_study(model)
    shown = [p for p in told["parameters"] if p["name"] in names]
    told["parameters"] = sorted(shown, key=lambda p: names.index(p["name"]))
    told["middle"] = {n: v for n, v in in_units(study, values).items() if n in names}
    told["effects"] = []
    others = {n: v for n, v in in_units(study, values).items() if n not in names}
    held = ", ".join(f"{n} = {v:.4g} {study.parameters[n].unit}" for n, v in others.items())
    told["notes"] = [
        ("values that are held", held),
        ("how the curves are made", "They are computed before, and interpolated in between."),
    ]
    return {"study": told, "grid": _grid(model, names, values)}


def strongest_pair(model: ExploredModel, values: Mapping[str, float]) -> list[str]:
    """Return the two parameters that move the fitted signals most, from limit to limit.

    A move is the root mean square of the change over the range of the measured values, summed over
    the signals.
    """
    problem = model.problem
    ends = np.array([problem.lower, problem.upper]).T
    size = len(problem.names)
    columns = {n: np.full(2 * size, values[n]) for n in problem.names}
    for i, name in enumerate(problem.names):
        columns[name][2 * i : 2 * i + 2] = ends[i]
    curves = model.simulate_all({**values, **columns}, 2 * size)
    moves = np.zeros(size)
    for channel in range(model.fitted):
        there = np.array([one.models[channel] for one in curves])
        change = there[1::2] - there[0::2]
        moves += np.nan_to_num(np.sqrt(np.mean(change**2, axis=1))) / np.ptp(model.target(channel))
    order = np.argsort(-moves, kind="stable")
    return [problem.names[i] for i in order[:2]]


def _grid(
    model: ExploredModel, names: Sequence[str], values: Mapping[str, float]
) -> dict[str, Any]:
    points = sum(drawn_points(model.target(i).size).size for i in range(len(model.signals)))
    most = _FOR_CURVES * 3 // 4 // (2 * points)
    steps = min(_MOST_STEPS[len(names)], most if len(names) == 1 else math.isqrt(most))
    if steps < _FEWEST_STEPS:
        raise StudyError("the curves do not fit into a page; give one slider by --sliders")
    of = [model.problem.names.index(name) for name in names]
    axes = [
        _axis(float(model.problem.lower[i]), float(model.problem.upper[i]), steps, values[name])
        for i, name in zip(of, names, strict=True)
    ]
    sets = np.array(list(itertools.product(*axes)))
    columns = {name: sets[:, k].copy() for k, name in enumerate(names)}
    runs = model.simulate_all({**values, **columns}, len(sets))
    channels = range(len(model.signals))
    parts = [_coded([in_shown_units(model, i, one.models[i]) for one in runs]) for i in channels]
    codes = np.concatenate([part for part, _ in parts], axis=1)
    factors = [model.study.parameters[name].factor for name in names]
    return {
        "names": list(names),
        "at": [(axis / factor).tolist() for axis, factor in zip(axes, factors, strict=True)],
        "scales": [scale for _, scale in parts],
        "curves": base64.b64encode(codes.astype("<u2").tobytes()).decode(),
    }


def _axis(low: float, high: float, steps: int, start: float) -> FloatArray:
    """Return even steps, the one nearest to the start moved there: the start is exact.

    >>> _axis(0.0, 1.0, 5, 0.3).tolist(), _axis(0.0, 1.0, 5, 1.0).tolist()
    ([0.0, 0.3, 0.5, 0.75, 1.0], [0.0, 0.25, 0.5, 0.75, 1.0])
    """
    axis = np.linspace(low, high, steps)
    if low < start < high and start not in axis:
        axis[np.clip(np.argmin(np.abs(axis - start)), 1, steps - 2)] = start
    return axis


def _coded(curves: Sequence[FloatArray]) -> tuple[FloatArray, tuple[float, float]]:
    """Return curves as whole numbers of 16 bits, shape (sets, points), with value 0 and step.

    >>> _coded([np.array([1.0, 2.0]), np.array([np.nan, 3.0])])[0].tolist()
    [[0.0, 32767.0], [65535.0, 65534.0]]
    """
    every = np.array(curves)
    finite = every[np.isfinite(every)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    step = (high - low) / (_FAILED - 1) or 1.0
    codes = np.where(np.isfinite(every), np.round((every - low) / step), _FAILED)
    return codes, (low, step)


def _start(session: Session, label: str) -> dict[str, float]:
    start = middle(session.base)
    if label and label not in session.sets:
        known = suggest(label, session.sets)
        raise StudyError(f"study '{session.study.name}' has no set '{label}'. {known}")
    chosen = label or next(iter(session.sets), "")
    given = session.sets.get(chosen, {})
    factors = {n: p.factor for n, p in session.study.parameters.items()}
    return start | {n: v * factors[n] for n, v in given.items()}


def _known(model: ExploredModel, name: str) -> str:
    if name not in model.problem.names:
        raise StudyError(
            f"sliders: '{name}' is no parameter with limits. {suggest(name, model.problem.names)}"
        )
    return name
