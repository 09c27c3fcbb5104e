"""Repeats of a collapsing mass loss rate: does the 95 % interval hold the truth?

    python tests/support/collapses.py

prints the share of seeded draws in which it does, by the way in which repeats are treated. The
curve rises, climbs and collapses; amplitude and length follow flux and thickness as the mass loss
rate of a slab does, to first order. Parameters are its amplitude, its length and its climb: the
first two are as uncertain as the repeats themselves, however many points are measured.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from pyrofit.cost import Target
from pyrofit.estimate.between_repeats import with_repeats
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.noise import NoiseModel
from pyrofit.solver.arrays import FloatArray

TIME = np.linspace(0.0, 1.0, 120)
TRUTH = np.array([1.0, 1.0, 0.3])
"""Amplitude, length, climb."""
SAME = np.array([1.0, 1.0, 0.0])
"""Thickness, flux and clock of repeats that do not differ."""
SCATTER = np.array([0.03, 0.03, 0.01])
"""Their standard deviations."""
NOISE = 0.02
NUISANCES = {"thickness_sd": "thickness", "flux_sd": "flux", "clock_sd_s": "clock"}


def curve(parameters: FloatArray, differing: FloatArray = SAME) -> FloatArray:
    """Return the rate of one repeat, shape (120,)."""
    amplitude, length, climb = parameters
    thickness, flux, clock = differing
    x = (TIME - clock) * flux / (length * thickness)
    rise, collapse = 1.0 / (1.0 + np.exp(-(x - 0.2) / 0.03)), 1.0 / (1.0 + np.exp((x - 0.8) / 0.04))
    return np.asarray(amplitude * flux * rise * (1.0 + climb * x) * collapse)


def records(repeats: int, rng: np.random.Generator, share: float = 1.0) -> FloatArray:
    """Return repeats that differ by a share of the scatter, with noise, shape (repeats, 120)."""
    differing = SAME + share * SCATTER * rng.standard_normal((repeats, 3))
    clean = np.array([curve(TRUTH, of) for of in differing])
    return clean + NOISE * rng.standard_normal(clean.shape)


def noise_of(
    measured: Sequence[FloatArray] | FloatArray, free: bool, times: Sequence[FloatArray] = ()
) -> tuple[NoiseModel, ...]:
    """Return the noise of repeats; ``free``: parameters stand for what differs."""
    runs, picks, terms = {}, [], []
    for i, value in enumerate(measured):
        time = times[i] if times else TIME
        repeat = SimpleNamespace(test="slab", nuisances=NUISANCES if free else {})
        runs[str(i)] = SimpleNamespace(experiment=SimpleNamespace(repeat=repeat))
        picks.append((str(i), "mlr", np.arange(time.size)))
        terms.append((1.0, SimpleNamespace(target=Target(time, value))))
    problem: Any = SimpleNamespace(
        names=tuple(NUISANCES.values()),
        runs=runs,
        picks=picks,
        cost=SimpleNamespace(terms=terms),
        temperature_K=lambda channel: None,
    )
    white = [NoiseModel(np.full(value.size, NOISE), Correlation()) for value in measured]
    return with_repeats(problem, white)


@dataclass(frozen=True)
class Result:
    """A fit: estimates and standard deviations of the parameters, chi-square per point."""

    values: FloatArray
    sd: FloatArray
    chi2: float

    @property
    def holds(self) -> FloatArray:
        """Whether each 95 % interval holds the truth."""
        return np.asarray(np.abs(self.values - TRUTH) < 1.96 * self.sd)


def fit(measured: FloatArray, noise: tuple[NoiseModel, ...], free: bool = False) -> Result:
    """Fit repeats jointly; ``free``: what differs is estimated, with its scatter as known."""

    def residuals(p: FloatArray) -> FloatArray:
        differing = p[3:].reshape(-1, 3) if free else np.tile(SAME, (len(measured), 1))
        white = [
            n.whiten(y - curve(p[:3], d))
            for n, y, d in zip(noise, measured, differing, strict=True)
        ]
        known = ((differing - SAME) / SCATTER).ravel() if free else np.empty(0)
        return np.concatenate([*white, known])

    start = np.concatenate([TRUTH, np.tile(SAME, len(measured) if free else 0)])
    found = least_squares(residuals, start, x_scale="jac")
    alone = np.linalg.inv(found.jac.T @ found.jac)
    covariance = alone.copy()
    rows = np.split(found.jac[: measured.size], len(measured))
    for n, J in zip(noise, rows, strict=True):
        if n.hidden is not None:
            hidden = n.whiten(n.hidden).T @ J @ alone
            covariance += hidden.T @ hidden
    return Result(found.x[:3], np.sqrt(np.diag(covariance))[:3], 2.0 * found.cost / measured.size)


def treated(way: str, measured: FloatArray) -> Result:
    """Return the fit of repeats that are treated in one way."""
    if way == "averaged":
        mean = measured.mean(axis=0, keepdims=True)
        sd = np.full(TIME.size, NOISE / np.sqrt(len(measured)))
        return fit(mean, (NoiseModel(sd, Correlation()),))
    free = way == "nuisances"
    return fit(measured, noise_of(measured, free), free)


WAYS = ("averaged", "floor", "nuisances")


def coverage(way: str, repeats: int, draws: int, seed: int = 1) -> tuple[FloatArray, float, float]:
    """Return how often the intervals hold the truth, chi-square per point, sd of the length."""
    found = []
    for i in range(draws):
        rng = np.random.default_rng([seed, repeats, i])
        found.append(treated(way, records(repeats, rng)))
    holds = np.mean([result.holds for result in found], axis=0)
    chi2 = float(np.median([result.chi2 for result in found]))
    return holds, chi2, float(np.median([result.sd[1] for result in found]))


if __name__ == "__main__":
    many = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    print("| repeats | treated | amplitude | length | climb | chi2 per point | sd of the length |")
    print("|---|---|---|---|---|---|---|")
    for count in (2, 3, 5):
        for how in WAYS:
            held, misfit, width = coverage(how, count, many)
            shares = " | ".join(f"{100 * share:.0f} %" for share in held)
            print(
                f"| {count} | {how} | {shares} | {misfit:.2f} | {100 * width:.2g} % |", flush=True
            )
