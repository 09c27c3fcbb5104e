"""The detectability of a twin's hidden effects, in standard deviations of its noise."""

from collections.abc import Mapping

import numpy as np
from scipy.optimize import least_squares

from pyrofit.config import Study, calibration_channels, diagnosed_parameters, true_description
from pyrofit.cost import Target
from pyrofit.errors import DataError
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.estimate.targets import Measurements
from pyrofit.model.signal import Noise
from pyrofit.solver.arrays import FloatArray

INSIDE = 1e-6
"""Least distance of the start from a limit, as a fraction of the limits' distance."""


def detectability(truth: Study, series: Measurements, known: Mapping[str, float]) -> float:
    """Return by how many standard deviations of the noise the best base model misses the truth.

    sqrt(min over x of |L^-1 (base(x) - y) / sd|^2 + |(x_k - truth) / sd_k|^2). y are the noise-free
    curves of the truth, computed by the solver of the fitted model. L and sd are the correlation
    and size of the true noise, the error of the clock included. x are the base parameters, searched
    from the truth; x_k are those with a known value.

    Parameters
    ----------
    truth
        Study of the truth, with its effects and its noise.
    series
        Measurements, for their times, by (experiment, signal).
    known
        Standard deviations of the parameters with a known value, in their units.

    Raises
    ------
    DataError
        A simulation of the truth does not finish.
    """
    base = _noise_free(truth, series)
    likelihood = Likelihood(base, _noise_models(truth, base))
    start = likelihood.scaled(_true_values(truth, base))
    rows = _known_rows(truth, base, known)

    def residuals(x: FloatArray) -> FloatArray:
        return np.concatenate([likelihood.residuals(x), rows @ (x - start)])

    def jacobian(x: FloatArray) -> FloatArray:
        return np.vstack([likelihood.jacobian(x), rows])

    x = np.clip(start, INSIDE, 1.0 - INSIDE)
    options = {"x_scale": "jac", "ftol": 1e-4, "max_nfev": 40}
    found = least_squares(residuals, x, jacobian, bounds=(0.0, 1.0), **options)
    return float(np.sqrt(2.0 * found.cost))


def _known_rows(truth: Study, base: Problem, known: Mapping[str, float]) -> FloatArray:
    """Return d((x_k - truth) / sd_k) / dx, shape (known, parameters), x scaled by the limits."""
    index = [base.names.index(name) for name in known]
    sds = np.array([sd * truth.parameters[name].factor for name, sd in known.items()])
    sds /= (base.upper - base.lower)[index]
    return np.asarray(np.eye(len(base.names))[index] / sds[:, None])


def _noise_free(truth: Study, series: Measurements) -> Problem:
    """Return the problem of the base model with noise-free curves of the truth as its targets."""
    material, experiments = true_description(truth)
    described = truth.model_copy(update={"experiments": experiments})
    names, channels = diagnosed_parameters(truth), calibration_channels(truth)
    fixed = truth.fixed_values()
    true = make_problem(described, names, channels, series, material, fixed)
    status, curves = true.simulate(_true_values(truth, true))
    if not status.finished:
        raise DataError(f"the truth cannot be simulated: {status.explanation}; change its effects")
    clean = {
        (c.experiment, c.signal): series[c.experiment, c.signal].assign(
            **{truth.experiments[c.experiment].quantity(c.signal).column: curve}
        )
        for c, curve in zip(channels, curves, strict=True)
    }
    return make_problem(truth, names, channels, clean, truth.material, fixed)


def _true_values(truth: Study, problem: Problem) -> FloatArray:
    assert truth.synthetic is not None
    values = truth.synthetic.truth
    return np.array([values[name] * truth.parameters[name].factor for name in problem.names])


def _noise_models(truth: Study, base: Problem) -> tuple[NoiseModel, ...]:
    terms = [term for _, term in base.cost.terms]
    return tuple(
        _noise(truth, name, signal, term.target)
        for (name, signal, _), term in zip(base.picks, terms, strict=True)
    )


def _noise(truth: Study, experiment: str, signal: str, clean: Target) -> NoiseModel:
    """Return the true noise, the stated error of the clock included."""
    described = truth.experiments[experiment].signals[signal]
    given: Noise = described.noise
    slope = np.gradient(clean.value, clean.time_s)
    sd = np.hypot(given.sd, described.timing_s * slope)
    return NoiseModel(sd, Correlation(lags=given.autocorrelation, ar=given.ar))
