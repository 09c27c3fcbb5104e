"""The effects of the apparatus on a run: uneven flux, clocks that differ, a drifting balance."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.model.slab_faces import FluxProfile
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray, IntArray, Value, Values
from pyrofit.solver.curves import Curves, Request, Runs

Run = Callable[[FloatArray | None, Mapping[str, Request]], Runs]
"""Runs under multiples of the flux, shape (runs,), at times of shape (runs, points). The number
of runs is a multiple of that of the sets, which are repeated. None stands for the flux itself."""
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(5)
"""Gauss's rule on (-1, 1), for fluxes that are spread evenly over the surface."""
RINGS = 4000
"""Rings of equal area into which a profile of the flux is cut to find its rule."""


def observe(
    experiment: SlabExperiment,
    values: Values,
    requests: Mapping[str, Request],
    run: Run,
    sets: int = 1,
) -> Runs:
    """Return the curves as the apparatus sees them.

    y(t) = offset + sum_g w_g y_g(t - delay), y_g the curve under the flux (1 + s x_g) q, with the
    spread s of the flux, Gauss's points x_g and weights w_g. With a profile of the flux over the
    radius, y is the mean of this over `rings`.

    Parameters
    ----------
    experiment
        The experiment, with ``front.spread``, ``front.profile`` and, by signal, ``delay_s`` and
        ``offset``.
    values
        Parameter values in SI units by name, each a number or of shape (sets,).
    requests
        Requests by signal.
    run
        The solver.
    sets
        Number of parameter sets.
    """
    every = {
        n: r.alone if sets == 1 else r.at(r.time_s[None].repeat(sets, axis=0))
        for n, r in requests.items()
    }
    if experiment.derived("shown as they are", _as_they_are):
        return run(None, every)
    shifted = {n: r.at(r.time_s - _of(experiment, n, "delay_s", values)) for n, r in every.items()}
    spread = np.full(sets, value_of(experiment.front.spread, values))
    runs = _mean_over_surface(spread, experiment.front.profile, shifted, run)
    signals = {
        name: curve + _of(experiment, name, "offset", values)
        for name, curve in runs.signals.items()
    }
    return runs._replace(signals=signals)


def _as_they_are(experiment: SlabExperiment) -> bool:
    """Tell whether the apparatus shows the curves as they are, whatever the parameters."""
    numbers = [n for signal in experiment.signals.values() for n in (signal.delay_s, signal.offset)]
    even = experiment.front.profile is None and experiment.front.spread == 0.0
    return even and all(number == 0.0 for number in numbers)


def observe_one(
    experiment: SlabExperiment,
    values: Mapping[str, float],
    requests: Mapping[str, Request],
    run: Callable[[float, Mapping[str, Request]], Curves],
) -> Curves:
    """Return the measured curves by a solver of one set, at times of the shape (points,)."""

    def runs(factors: FloatArray | None, asked: Mapping[str, Request]) -> Runs:
        plain = {n: requests[n].at(r.time_s[0]) for n, r in asked.items()}
        found = [run(factor, plain) for factor in ([1.0] if factors is None else factors.tolist())]
        missing = {name: np.full(r.time_s.shape, np.nan) for name, r in plain.items()}
        return Runs(
            status=np.array([one.status for one in found]),
            signals={n: np.array([(one.signals or missing)[n] for one in found]) for n in plain},
            cells=np.array([one.cells for one in found]),
            steps=np.array([one.steps for one in found]),
            energy_error=np.array([one.energy_error for one in found]),
            mass_error=np.array([one.mass_error for one in found]),
        )

    return observe(experiment, values, requests, runs).curves()[0]


def _of(experiment: SlabExperiment, name: str, key: str, values: Values) -> Value:
    """Return a value of a signal, of several sets in a column."""
    signal = experiment.signals.get(name)
    value: Value = 0.0 if signal is None else value_of(getattr(signal, key), values)
    return value[:, None] if isinstance(value, np.ndarray) else value


def rings(profile: FluxProfile | None) -> tuple[FloatArray, FloatArray]:
    """Return relative fluxes and weights of Gauss's rule for a flux profile, shape (points,).

    The mean over the area, (2/R^2) int y(f(r)) r dr, is one over the values that f takes. The rule
    of five points that this distribution has is exact for y a polynomial in f of degree 9; a flat
    profile has one point. It follows from f on rings of equal area by Lanczos's recurrence (Golub
    and Welsch 1969, doi:10.1090/S0025-5718-69-99647-1).

    >>> rings(FluxProfile(radius_m=(0.0, 0.05), relative_flux=(0.9, 0.9)))[0]
    array([0.9])
    """
    if profile is None or len(set(profile.relative_flux)) == 1:
        return np.array([1.0 if profile is None else profile.relative_flux[0]]), np.ones(1)
    area = (np.arange(RINGS) + 0.5) / RINGS
    f = np.interp(profile.radius_m[-1] * np.sqrt(area), profile.radius_m, profile.relative_flux)
    before, now = np.zeros(RINGS), np.full(RINGS, np.sqrt(1.0 / RINGS))
    alpha, beta = [], [0.0]
    for _ in POINTS:
        alpha.append(linear.dot(now, f * now))
        rest = (f - alpha[-1]) * now - beta[-1] * before
        beta.append(linear.norm(rest))
        if beta[-1] < 1e-9:
            break
        before, now = now, rest / beta[-1]
    off = beta[1 : len(alpha)]
    factors, vectors = linear.eigen(np.diag(alpha) + np.diag(off, 1) + np.diag(off, -1))
    return factors, vectors[0] ** 2


def _mean_over_surface(
    spread: FloatArray, profile: FluxProfile | None, requests: Mapping[str, Request], run: Run
) -> Runs:
    """Return the mean over the fluxes of the surface, and the worst of their ends and balances.

    All fluxes of all sets, whose spreads are of shape (sets,), run side by side.
    """
    ring_factors, ring_weights = rings(profile)
    points, weights = (POINTS, 0.5 * WEIGHTS) if spread.any() else (np.zeros(1), np.ones(1))
    factors = ring_factors[:, None, None] * (1.0 + points[:, None] * spread)
    shape = factors.shape
    if factors.size == spread.size:
        return run(factors.ravel(), requests)
    copies = factors.size // spread.size
    runs = run(factors.ravel(), {name: _repeated(r, copies) for name, r in requests.items()})
    ring, middle = int(np.argmax(ring_weights)), int(np.argmax(weights))

    def mean(curves: FloatArray) -> FloatArray:
        by_flux = curves.reshape(*shape, -1)
        over_spread = _weighted(by_flux.swapaxes(0, 1), weights)
        even = np.where(spread[:, None] == 0.0, by_flux[:, middle], over_spread)
        return _weighted(even, ring_weights)

    def worst(of: FloatArray | IntArray) -> Any:
        return of.reshape(-1, spread.size).max(axis=0)

    return Runs(
        status=worst(runs.status),
        signals={name: mean(curves) for name, curves in runs.signals.items()},
        cells=runs.cells.reshape(shape)[ring, middle],
        steps=runs.steps.reshape(shape)[ring, middle],
        energy_error=worst(runs.energy_error),
        mass_error=worst(runs.mass_error),
    )


def _weighted(curves: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the weighted sum over the first axis, term by term; of one curve itself."""
    if len(curves) == 1 and weights[0] == 1.0:
        return np.asarray(curves[0])
    return np.asarray(sum(w * curve for w, curve in zip(weights, curves, strict=True)))


def _repeated(request: Request, copies: int) -> Request:
    """Return a request of several sets, shape (sets, points), for copies of them."""
    place = request.place
    if place is not None:
        place = replace(place, depth_m=np.tile(place.depth_m, copies))
    return replace(request, time_s=np.tile(request.time_s, (copies, 1)), place=place)
