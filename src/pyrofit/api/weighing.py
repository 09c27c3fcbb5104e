"""Weights of signals in a likelihood."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from pyrofit.api.choices import Key, signals_of
from pyrofit.config import Study
from pyrofit.errors import StudyError
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.solver.arrays import FloatArray

Weights = Mapping[Any, Any]
"""A number, or an array of the shape (points,), by experiment or by (experiment, signal)."""


def weights_of(study: Study, keys: Collection[Key], given: Weights | None) -> dict[Key, FloatArray]:
    """Return the weights of signals, each of the shape () or (points,).

    Raises
    ------
    StudyError
        A name is not known or not fitted, or a weight is no finite number above 0.
    """
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise StudyError(
            "weights: numbers by experiment are needed, such as {'tga_10K': 2.0}; this is a "
            f"{type(given).__name__}"
        )
    found: dict[Key, FloatArray] = {}
    for one, weight in given.items():
        own = [key for key in signals_of(study, [one]) if key in keys]
        if not own:
            fitted = ", ".join(".".join(key) for key in keys)
            raise StudyError(f"weights: {one!r} is not fitted. Fitted: {fitted}")
        found |= dict.fromkeys(own, _checked(one, weight))
    return found


def _checked(name: Any, given: Any) -> FloatArray:
    try:
        weight = np.array(given, dtype=float)
    except (TypeError, ValueError):
        raise StudyError(f"weights: that of {name!r} is neither a number nor an array") from None
    if weight.ndim > 1 or not (np.isfinite(weight).all() and (weight > 0.0).all()):
        raise StudyError(
            f"weights: those of {name!r} must be a finite number above 0, or one for each point; "
            "to leave points out, give a series without them"
        )
    return weight


def weighted(likelihood: Likelihood, weights: Mapping[Key, FloatArray]) -> Likelihood:
    """Return the likelihood whose noise counts as 1/w of its size.

    Raises
    ------
    StudyError
        A signal has another number of points than of weights.
    """
    noise = list(likelihood.noise)
    for k, (name, signal, _) in enumerate(likelihood.problem.picks):
        weight = weights.get((name, signal))
        if weight is None:
            continue
        points = noise[k].sd.size
        if weight.shape not in ((), (points,)):
            raise StudyError(
                f"weights: {weight.size} are given for {name}, {signal}, which has {points} points"
            )
        noise[k] = noise[k].weighted(weight)
    return replace(likelihood, noise=tuple(noise))
