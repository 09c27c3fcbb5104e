"""What the apparatus makes of a run: uneven flux, clocks that differ, a balance that drifts."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.experiment import Gasification
from pyrofit.solver.curves import Curves, Request

Run = Callable[[float, Mapping[str, Request]], Curves]
"""A run under a multiple of the flux, and its curves at the requests."""
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(5)
"""Gauss's rule on (-1, 1), for fluxes that are spread evenly over the surface."""


def observe(
    experiment: Gasification,
    values: Mapping[str, float],
    requests: Mapping[str, Request],
    run: Run,
) -> Curves:
    """Return the curves as the apparatus sees them.

    y(t) = offset + sum_g w_g y_g(t - delay), y_g the curve under the flux (1 + s x_g) q, with the
    spread s of the flux, Gauss's points x_g and weights w_g.

    Parameters
    ----------
    experiment
        The experiment, with ``front.spread`` and, by signal, ``delay_s`` and ``offset``.
    values
        Parameter values in SI units by name.
    requests
        What is asked for, by signal.
    run
        The solver.
    """
    shifted = {
        name: replace(request, time_s=request.time_s - _of(experiment, name, "delay_s", values))
        for name, request in requests.items()
    }
    curves = _spread(value_of(experiment.front.spread, values), shifted, run)
    signals = {
        name: curve + _of(experiment, name, "offset", values)
        for name, curve in curves.signals.items()
    }
    return replace(curves, signals=signals)


def _of(experiment: Gasification, name: str, key: str, values: Mapping[str, float]) -> float:
    signal = experiment.signals.get(name)
    return 0.0 if signal is None else value_of(getattr(signal, key), values)


def _spread(spread: float, requests: Mapping[str, Request], run: Run) -> Curves:
    if spread == 0.0:
        return run(1.0, requests)
    runs = [run(1.0 + spread * float(x), requests) for x in POINTS]
    failed = [r for r in runs if not r.status.finished]
    if failed:
        return failed[0]
    weights = 0.5 * WEIGHTS
    signals = {
        name: np.einsum("g,gt->t", weights, [r.signals[name] for r in runs]) for name in requests
    }
    worst = max(runs, key=lambda r: r.status)
    return replace(worst, signals=signals)
