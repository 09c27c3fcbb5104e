"""Fit of one scheme to records from several starts, its discrepancy estimated."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.estimate.likelihood import Likelihood, fit
from pyrofit.estimate.pose import Estimation, pose
from pyrofit.estimate.posterior import covariance
from pyrofit.estimate.prior import NormalPrior, prior_of
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.targets import Measurements
from pyrofit.numerics import functions, linear
from pyrofit.scheme.noise import RecordScatter, deviance, most_likely
from pyrofit.scheme.posed import Posed
from pyrofit.scheme.records import MassRecord
from pyrofit.scheme.settings import SchemeSettings
from pyrofit.solver.arrays import FloatArray

LITTLE = 0.5
"""Gain in deviance below which the sizes are not estimated once more."""


@dataclass(frozen=True, eq=False)
class SchemeSetting:
    """Data and settings that all fits of a study share."""

    study: Study
    measurements: Measurements
    records: tuple[MassRecord, ...]
    settings: SchemeSettings

    @property
    def calibrated(self) -> tuple[MassRecord, ...]:
        """Records that schemes are fitted to."""
        return tuple(r for r in self.records if r.calibrated)

    @cached_property
    def _scatters(self) -> dict[str, RecordScatter]:
        return {r.experiment: RecordScatter(r, self.settings) for r in self.records}

    def scatters(self, records: Sequence[MassRecord]) -> tuple[RecordScatter, ...]:
        """Return the scatter of some records."""
        return tuple(self._scatters[r.experiment] for r in records)


@dataclass(frozen=True, eq=False)
class FittedScheme:
    """A scheme fitted to records.

    Parameters
    ----------
    posed
        The scheme as a study.
    records
        The records that it is fitted to.
    likelihood
        Of these records.
    x
        The fit, in [0, 1] of the search range.
    size
        Size s of the misfit beyond the noise, as a fraction of the initial mass.
    deviance
        -2 log likelihood, priors of nuisance parameters included.
    """

    posed: Posed
    records: tuple[MassRecord, ...]
    likelihood: Likelihood
    x: FloatArray
    size: float
    deviance: float

    @property
    def name(self) -> str:
        """Identifier of the scheme."""
        return self.posed.name

    @property
    def values(self) -> dict[str, float]:
        """Fitted parameters, SI units."""
        found = self.likelihood.values(self.x).tolist()
        return dict(zip(self.posed.names, found, strict=True))

    @property
    def bic(self) -> float:
        """-2 log likelihood + p log n (Schwarz 1978, doi 10.1214/aos/1176344136).

        p counts the parameters and the size of the discrepancy, n the points.
        """
        points = sum(self.likelihood.points)
        return self.deviance + (self.posed.count + 1) * float(functions.log(points))

    def spread(self) -> FloatArray:
        """Return the covariance of x, shape (parameters, parameters)."""
        residuals = self.likelihood.residuals(self.x)
        return covariance(self.likelihood.jacobian(self.x, residuals))

    def residuals(self) -> list[FloatArray]:
        """Return simulated minus measured mass of each record."""
        return _residuals(self.likelihood, self.x)


def problem_of(
    setting: SchemeSetting, posed: Posed, records: Sequence[MassRecord]
) -> tuple[Problem, NormalPrior]:
    """Return the problem of a scheme at some records, and the known values of its parameters."""
    study, names = posed.study, posed.names
    asked = Estimation(names, [r.term for r in records], study.material)
    problem = pose(study, asked, setting.measurements, study.fixed_values())
    known = prior_of(study, problem)
    sd = setting.settings.laboratory_shift_K
    at = tuple(names.index(name) for name in posed.offsets)
    prior = NormalPrior(
        known.index + at,
        np.append(known.mean, np.zeros(len(at))),
        np.append(known.sd, np.full(len(at), sd)),
    )
    return problem, prior


def fit_posed(
    setting: SchemeSetting,
    posed: Posed,
    records: Sequence[MassRecord],
    starts: Sequence[Mapping[str, float]],
    rng: np.random.Generator,
    size: float | None = None,
    random: int | None = None,
) -> FittedScheme:
    """Fit a scheme to records.

    Parameters
    ----------
    setting
        Data and settings that all fits share.
    posed
        The scheme.
    records
        Records to fit it to.
    starts
        Values of parameters to start from, SI units; missing ones are drawn.
    rng
        Draws the random starts.
    size
        Size of the discrepancy at first; default: the largest.
    random
        Number of random starts; default: that of the settings.

    Raises
    ------
    DataError
        No set within the limits can be simulated.
    """
    settings = setting.settings
    problem, prior = problem_of(setting, posed, records)
    scatters = setting.scatters(records)
    size = settings.discrepancies[-1] if size is None else size
    likelihood = _likelihood(problem, scatters, size, prior)
    count = settings.random_starts if random is None else random
    x = fit(likelihood, _points(likelihood, starts, rng, count)).x
    lowest = np.inf
    for _ in range(settings.rounds):
        size = most_likely(scatters, _residuals(likelihood, x))
        likelihood = _likelihood(problem, scatters, size, prior)
        x = likelihood.descend(x).x
        now = deviance(scatters, _residuals(likelihood, x), size) + _known(likelihood, x)
        gain, lowest = lowest - now, now
        if gain < LITTLE:
            break
    return FittedScheme(posed, tuple(records), likelihood, x, size, lowest)


def _likelihood(
    problem: Problem, scatters: Sequence[RecordScatter], size: float, prior: NormalPrior
) -> Likelihood:
    return Likelihood(problem, tuple(s.noise(size) for s in scatters), prior)


def _known(likelihood: Likelihood, x: FloatArray) -> float:
    """Return the sum of the squared residuals of the known values."""
    rows = likelihood.prior.residuals(likelihood.values(x)[None])[0]
    return linear.dot(rows, rows)


def _residuals(likelihood: Likelihood, x: FloatArray) -> list[FloatArray]:
    curves = likelihood.curves(x)
    if curves is None:
        raise DataError("a reaction scheme cannot be simulated at any set within its limits")
    measured = np.concatenate([t.target.value for _, t in likelihood.problem.cost.terms])
    return likelihood.split(curves - measured)


def _points(
    likelihood: Likelihood,
    starts: Sequence[Mapping[str, float]],
    rng: np.random.Generator,
    random: int,
) -> list[FloatArray]:
    """Return starts in [0, 1]: those given, missing values drawn, and random ones."""
    names, known = likelihood.problem.names, likelihood.prior.index
    drawn = []
    for given in [*starts, *({} for _ in range(random))]:
        x = rng.uniform(0.1, 0.9, len(names))
        x[list(known)] = likelihood.scaled(_means(likelihood))[list(known)]
        values = likelihood.values(x)
        for i, name in enumerate(names):
            values[i] = given.get(name, values[i])
        drawn.append(likelihood.scaled(values))
    return drawn


def _means(likelihood: Likelihood) -> FloatArray:
    values = 0.5 * (likelihood.problem.lower + likelihood.problem.upper)
    values[list(likelihood.prior.index)] = likelihood.prior.mean
    return np.asarray(values)
