"""What the apparatus makes of a run: uneven flux, clocks that differ, a balance that drifts."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.model.slab_faces import FluxProfile
from pyrofit.solver.arrays import FloatArray, Value, Values
from pyrofit.solver.curves import Curves, Request, Runs

Run = Callable[[FloatArray, Mapping[str, Request]], Runs]
"""Runs under multiples of the flux, shape (sets,), at times of shape (sets, points)."""
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(5)
"""Gauss's rule on (-1, 1), for fluxes that are spread evenly over the surface."""
MIDDLE = 2
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
    spread s of the flux, Gauss's points x_g and weights w_g. Of a profile of the flux over the
    radius it is the mean of that over `rings`.

    Parameters
    ----------
    experiment
        The experiment, with ``front.spread``, ``front.profile`` and, by signal, ``delay_s`` and
        ``offset``.
    values
        Parameter values in SI units by name, each a number or of shape (sets,).
    requests
        What is asked for, by signal.
    run
        The solver.
    sets
        Number of parameter sets.
    """
    shifted = {
        name: replace(
            r,
            time_s=np.broadcast_to(r.time_s, (sets, r.time_s.size))
            - _of(experiment, name, "delay_s", values),
        )
        for name, r in requests.items()
    }
    spread = np.full(sets, value_of(experiment.front.spread, values))
    factors, weights = rings(experiment.front.profile)
    runs = _mean([_spread(spread, shifted, _under(f, run)) for f in factors.tolist()], weights)
    signals = {
        name: curve + _of(experiment, name, "offset", values)
        for name, curve in runs.signals.items()
    }
    return replace(runs, signals=signals)


def observe_one(
    experiment: SlabExperiment,
    values: Mapping[str, float],
    requests: Mapping[str, Request],
    run: Callable[[float, Mapping[str, Request]], Curves],
) -> Curves:
    """Return the same for a solver of one set, whose times asked for have the shape (points,)."""

    def runs(factor: FloatArray, asked: Mapping[str, Request]) -> Runs:
        plain = {name: replace(r, time_s=r.time_s[0]) for name, r in asked.items()}
        one = run(float(factor[0]), plain)
        missing = {name: np.full(r.time_s.shape, np.nan) for name, r in plain.items()}
        return Runs(
            status=np.array([one.status]),
            signals={name: curve[None] for name, curve in (one.signals or missing).items()},
            cells=np.array([one.cells]),
            steps=np.array([one.steps]),
            energy_error=np.array([one.energy_error]),
            mass_error=np.array([one.mass_error]),
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
        alpha.append(float(now @ (f * now)))
        rest = (f - alpha[-1]) * now - beta[-1] * before
        beta.append(float(np.linalg.norm(rest)))
        if beta[-1] < 1e-9:
            break
        before, now = now, rest / beta[-1]
    off = beta[1 : len(alpha)]
    factors, vectors = np.linalg.eigh(np.diag(alpha) + np.diag(off, 1) + np.diag(off, -1))
    return factors, vectors[0] ** 2


def _under(factor: float, run: Run) -> Run:
    """Return the run under a multiple of the flux."""
    return run if factor == 1.0 else lambda of, asked: run(factor * of, asked)


def _mean(runs: Sequence[Runs], weights: FloatArray) -> Runs:
    """Return the weighted mean of runs, and the worst of their ends and balances."""
    if len(runs) == 1:
        return runs[0]
    middle = runs[int(np.argmax(weights))]
    signals = {
        name: np.asarray(sum(w * r.signals[name] for w, r in zip(weights, runs, strict=True)))
        for name in middle.signals
    }
    return replace(
        middle,
        status=np.max([r.status for r in runs], axis=0),
        signals=signals,
        energy_error=np.max([r.energy_error for r in runs], axis=0),
        mass_error=np.max([r.mass_error for r in runs], axis=0),
    )


def _spread(spread: FloatArray, requests: Mapping[str, Request], run: Run) -> Runs:
    if not spread.any():
        return run(np.ones(spread.size), requests)
    runs = [run(1.0 + spread * float(x), requests) for x in POINTS]
    even = spread == 0.0
    weights = 0.5 * WEIGHTS
    signals = {}
    for name in requests:
        mean = sum(w * r.signals[name] for w, r in zip(weights, runs, strict=True))
        signals[name] = np.where(even[:, None], runs[MIDDLE].signals[name], mean)
    return replace(
        runs[MIDDLE],
        status=np.max([r.status for r in runs], axis=0),
        signals=signals,
        energy_error=np.max([r.energy_error for r in runs], axis=0),
        mass_error=np.max([r.mass_error for r in runs], axis=0),
    )
