"""Whether a fitted model describes its signals, tested against their noise.

Two statistics of the whitened residuals are compared with those of noise, projected as the fit
projects it. The windows of `pyrofit.estimate.lasting_misfit` find errors that last, chi-square
finds the others. Of the false alarms, nine tenths may come from windows, one tenth from chi-square.
Misfit that repeats share is tested beside (`common_misfit`), at nine tenths of the level again. The
p-value is the smallest probability over these shares. Points that scatter more
than their noise do not count as an error of the model. Residuals are first divided by their
scatter from point to point, where that is larger.

The size of a noise that is not stated comes from the same record, with n - k degrees of freedom for
a curve of k splines. Chi-square over its own degrees of freedom is then compared with Fisher's F.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.special import chdtrc, fdtrc

from pyrofit.cost import Target
from pyrofit.cost.distances import root_mean_square
from pyrofit.estimate import lasting_misfit
from pyrofit.estimate.between_repeats import groups_of_repeats
from pyrofit.estimate.common_misfit import p_of_repeats
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.posterior import Posterior
from pyrofit.estimate.projection import spanned_by
from pyrofit.estimate.repeats_agree import differences, is_held, tolerance_of
from pyrofit.model.experiment import Experiment
from pyrofit.numerics import linear
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.integral import integral
from pyrofit.results.goodness import LEVEL, Goodness, Miss, RepeatDiffers, SignalGoodness
from pyrofit.solver.arrays import FloatArray

OF_WINDOWS = 0.9
"""Share of the false alarms that windows may raise; chi-square may raise the others."""
OF_REPEATS = 0.9
"""The same of the misfit that repeats share. Windows of few repeats hardly raise any."""
MOST_WINDOWS = 3
"""Windows of misfit of a signal that are named at most."""
AVERAGED = 0.01
"""Half of the window over which a difference is averaged, as a fraction of the record."""
LONG = 0.02
"""The same for errors that last, which no noise of the tests may excuse."""
FAR = 2.0
"""Standard deviations by which a missed window is off."""


def goodness_of_fit(likelihood: Likelihood, posterior: Posterior, curves: FloatArray) -> Goodness:
    """Test the residuals of a fit.

    Parameters
    ----------
    likelihood
        With the noise alone; a discrepancy in it would count as noise.
    posterior
        The fit, with its residuals and derivatives.
    curves
        The simulated channels there, one after the other, shape (points,).
    """
    spanned = spanned_by(posterior.free_jacobian)[: posterior.residuals.size]
    whole_parts = likelihood.split(posterior.residuals)
    scatters = [scatter(part) for part in whole_parts]
    parts = [part / s for part, s in zip(whole_parts, scatters, strict=True)]
    largest, drawn = lasting_misfit.largest(likelihood, parts, spanned)
    used = [float(np.sum(part**2)) for part in likelihood.split(spanned)]
    of_squares = [
        _p_of_squares(noise, linear.dot(part, part), part.size - taken)
        for noise, part, taken in zip(likelihood.noise, parts, used, strict=True)
    ]
    of_windows = [_p_of_windows(drawn[:, k], own) for k, own in enumerate(largest)]
    shared = p_of_repeats(likelihood, curves)
    of_repeats = {k: p for group, p in shared for k in group}
    whole = _together(
        _p_of_windows(drawn.max(axis=1), float(largest.max())),
        len(parts) * min(of_squares),
        min((len(shared) * p for _, p in shared), default=1.0),
    )
    signals = tuple(
        _signal(
            likelihood,
            k,
            _together(of_windows[k], of_squares[k], of_repeats.get(k, 1.0)),
            scatters[k],
            curves,
        )
        for k in range(len(parts))
    )
    return Goodness(whole, signals, tuple(differing(likelihood, curves)))


def differing(likelihood: Likelihood, curves: FloatArray) -> Iterator[RepeatDiffers]:
    """Yield the repeats that differ, of tests whose differences no parameter describes.

    Where they are described differently, such as boards of other masses, the simulated differences
    are taken out.
    """
    problem, simulated = likelihood.problem, likelihood.split(curves)
    for group in groups_of_repeats(problem):
        temperatures = [problem.temperature_K(i) for i in group]
        times = [problem.cost.terms[i][1].target.time_s for i in group]
        values = [problem.cost.terms[i][1].target.value for i in group]
        held = any(
            T is not None and is_held(T, v) for T, v in zip(temperatures, values, strict=True)
        )
        at = [t if T is None or held else T for T, t in zip(temperatures, times, strict=True)]
        name, signal, _ = problem.picks[group[0]]
        quantity = problem.runs[name].experiment.quantity(signal)
        if len({_description(problem.runs[problem.picks[i][0]].experiment) for i in group}) > 1:
            values = [
                value - simulated[i] + np.interp(own, at[0], simulated[group[0]])
                for i, own, value in zip(group, at, values, strict=True)
            ]
        for d in differences(at, values, tolerance_of(quantity, held)):
            name, signal, _ = problem.picks[group[d.position]]
            yield RepeatDiffers(name, signal, d.kind, d.size, d.low, d.high, held)


def _description(experiment: Experiment) -> str:
    """Return all that a simulation reads of an experiment, but for its records."""
    return experiment.model_dump_json(exclude={"signals", "title", "repeat"})


def scatter(w: FloatArray) -> float:
    """Return the standard deviation of white residuals from point to point, 1 at least.

    s^2 = sum (w_(i+1) - w_i)^2 / (2 (n - 1)) (von Neumann 1941, doi 10.1214/aoms/1177731677).
    Errors that last hardly change it. It counts where it is above 1 by more than chance.

    >>> scatter(np.array([0.1, 0.2, 0.1])), scatter(np.tile([3.0, -3.0], 100)) > 4.0
    (1.0, True)
    """
    steps = np.diff(w)
    if steps.size < 1:
        return 1.0
    square = linear.dot(steps, steps) / (2.0 * steps.size)
    # Its standard deviation is sqrt(3/n) for white noise of unit variance.
    return float(np.sqrt(square)) if square > 1.0 + FAR * np.sqrt(3.0 / w.size) else 1.0


def _p_of_windows(drawn: FloatArray, shown: float) -> float:
    return float(1 + np.count_nonzero(drawn >= shown)) / (1 + drawn.size)


def _p_of_squares(noise: NoiseModel, squares: float, freedom: float) -> float:
    freedom = max(freedom, 1.0)
    if noise.splines == 0 or (noise.stated and noise.excess == 1.0):
        return float(chdtrc(freedom, squares))
    return float(fdtrc(freedom, max(noise.sd.size - noise.splines, 1), squares / freedom))


def _together(of_windows: float, of_squares: float, of_repeats: float) -> float:
    shares = of_windows / OF_WINDOWS, of_squares / (1.0 - OF_WINDOWS), of_repeats / OF_REPEATS
    return min(1.0, *shares)


def _signal(
    likelihood: Likelihood, channel: int, p: float, scatter_of: float, curves: FloatArray
) -> SignalGoodness:
    experiment, signal, _ = likelihood.problem.picks[channel]
    noise, target = likelihood.noise[channel], likelihood.problem.cost.terms[channel][1].target
    difference = likelihood.split(curves)[channel] - target.value
    temperature = likelihood.problem.temperature_K(channel)
    quantity = likelihood.problem.runs[experiment].experiment.quantity(signal)
    averaged = moving_mean(difference, LONG)
    found = SignalGoodness(
        experiment=experiment,
        signal=signal,
        p=p,
        rms=root_mean_square(difference),
        range=float(np.ptp(target.value)),
        points_sd=float(np.median(noise.sd)),
        scatter=scatter_of,
        averaged=root_mean_square(averaged),
        total=_total(quantity, target, difference),
        of_sample=quantity.against_temperature,
        misses=(),
    )
    if p >= LEVEL and not found.far_off:
        return found
    windows = missed(difference, noise.total_sd)
    misses = tuple(_miss(*w, target.time_s, temperature, difference) for w in windows)
    return replace(found, misses=misses)


def moving_mean(values: FloatArray, share: float) -> FloatArray:
    """Return the mean over a window of twice a share of the record about each point.

    >>> moving_mean(np.array([0.0, 3.0, 0.0, 0.0]), 0.25)
    array([1.5, 1. , 1. , 0. ])
    """
    n = values.size
    width = max(1, round(share * n))
    total = np.concatenate([[0.0], np.cumsum(values)])
    low, high = np.maximum(np.arange(n) - width, 0), np.minimum(np.arange(n) + width + 1, n)
    return np.asarray((total[high] - total[low]) / (high - low))


def _total(quantity: Quantity, target: Target, difference: FloatArray) -> float | None:
    """Return the simulated over the measured integral of a rate."""
    if quantity.sampling != "bin mean" and "heat_of_combustion_J_kg" not in quantity.rests_on:
        return None
    whole = integral(target.time_s, target.value)
    return 1.0 + integral(target.time_s, difference) / whole if whole > 0.0 else None


def missed(difference: FloatArray, sd: FloatArray) -> list[tuple[int, int]]:
    """Return where a series is off to one side, first and last point, the largest of these first.

    The difference is averaged over `AVERAGED` of the record, and exceeds `FAR` standard deviations
    there; if it does so nowhere, all of the record counts.

    Parameters
    ----------
    difference
        Simulated less measured values, shape (n,).
    sd
        Standard deviation of the noise with its lasting errors, shape (n,).
    """
    n = difference.size
    mean = moving_mean(difference / sd, AVERAGED)
    sign = np.where(np.abs(mean) > FAR, np.sign(mean), 0.0)
    edges = np.flatnonzero(np.diff(sign)) + 1
    runs = zip([0, *edges.tolist()], [*edges.tolist(), n], strict=True)
    found = [(a, b - 1) for a, b in runs if sign[a]] or [(0, n - 1)]
    size = {w: abs(float(np.sum(mean[w[0] : w[1] + 1]))) for w in found}
    return sorted(sorted(found, key=lambda w: -size[w])[:MOST_WINDOWS])


def _miss(
    first: int,
    last: int,
    time: FloatArray,
    temperature: FloatArray | None,
    difference: FloatArray,
) -> Miss:
    ends = (None, None) if temperature is None else (temperature[first], temperature[last])
    low, high = (None if T is None else float(T) for T in ends)
    inside = difference[first : last + 1]
    mean, rms = float(np.mean(inside)), root_mean_square(inside)
    return Miss(float(time[first]), float(time[last]), low, high, mean, rms)
