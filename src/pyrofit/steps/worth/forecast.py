"""Curves of tests that were not made or not fitted, and their derivatives at the best fit."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pyrofit.estimate.derivatives import derivatives
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.experiments import kind_of
from pyrofit.model.experiment import Experiment
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray, Values
from pyrofit.solver.curves import Request


@dataclass(frozen=True, eq=False)
class Forecast:
    """Curves of a test at the best fit, by signal, and d curve / d x, (points, parameters).

    x are the parameters of the likelihood, in distances of their limits.
    """

    experiment: Experiment
    requests: Mapping[str, Request]
    curves: Mapping[str, FloatArray]
    slopes: Mapping[str, FloatArray]


def simulated_curves(
    likelihood: Likelihood,
    experiment: Experiment,
    requests: Mapping[str, Request],
    X: FloatArray,
    led: bool = False,
) -> list[FloatArray | None]:
    """Return the curves of a test, one after the other, of sets; None where a run fails.

    The sets may be ``led`` by the first one, see `pyrofit.simulate.simulate_slabs`.
    """
    problem = likelihood.problem
    columns = dict(zip(problem.names, likelihood.values(X).T, strict=True))
    values: Values = {**problem.fixed, **columns}
    simulate = kind_of(experiment).simulate
    [runs] = simulate(
        [experiment], problem.material, values, [requests], problem.accuracy, len(X), led
    )
    return [
        np.concatenate([run.signals[s] for s in requests]) if run.status.finished else None
        for run in runs
    ]


def forecast_test(
    likelihood: Likelihood, x: FloatArray, experiment: Experiment, requests: Mapping[str, Request]
) -> Forecast | None:
    """Return curves and derivatives of a test at x; None where a run does not finish."""

    def curves(X: FloatArray) -> list[FloatArray | None]:
        return simulated_curves(likelihood, experiment, requests, X, led=True)

    here = curves(x[None])[0]
    if here is None:
        return None
    slopes, found = derivatives(curves, x, here)
    if not np.all(found):
        return None
    ends = np.cumsum([request.time_s.size for request in requests.values()])[:-1]
    return Forecast(
        experiment,
        requests,
        dict(zip(requests, np.split(here, ends), strict=True)),
        dict(zip(requests, np.split(slopes, ends), strict=True)),
    )


@dataclass(frozen=True, eq=False)
class Lasting:
    """The lasting errors of a record besides its noise: directions, and shares whitening takes.

    The shapes are (points, values) and (values,). By default there are none.
    """

    directions: FloatArray | None = None
    shares: FloatArray | None = None

    def whiten(self, white: FloatArray) -> FloatArray:
        """Whiten values that are white except for this, shape (points,) or (points, k)."""
        if self.directions is None or self.shares is None:
            return white
        shares = self.shares if white.ndim == 1 else self.shares[:, None]
        inside = shares * (linear.product(self.directions.T, white))
        return np.asarray(white - linear.product(self.directions, inside))


@dataclass(frozen=True, eq=False)
class ForecastRecord:
    """A further record: some signals of a forecast, with their noise."""

    forecast: Forecast
    noise: Mapping[str, NoiseModel]
    lasting: Lasting = Lasting()

    @property
    def jacobian(self) -> FloatArray:
        """Whitened derivatives, shape (points, parameters)."""
        parts = [n.whiten(self.forecast.slopes[s]) for s, n in self.noise.items()]
        return self.lasting.whiten(np.concatenate(parts))

    def whitened(
        self, likelihood: Likelihood, X: FloatArray, led: bool = False
    ) -> list[FloatArray | None]:
        """Return the whitened differences of the curves of sets from those of the best fit.

        The sets may be ``led`` by the first one, see `pyrofit.simulate.simulate_slabs`.
        """
        asked = {s: self.forecast.requests[s] for s in self.noise}
        ends = np.cumsum([r.time_s.size for r in asked.values()])[:-1]

        def white(there: FloatArray) -> FloatArray:
            parts = zip(self.noise.items(), np.split(there, ends), strict=True)
            found = [n.whiten(c - self.forecast.curves[s]) for (s, n), c in parts]
            return self.lasting.whiten(np.concatenate(found))

        curves = simulated_curves(likelihood, self.forecast.experiment, asked, X, led)
        return [None if there is None else white(there) for there in curves]
