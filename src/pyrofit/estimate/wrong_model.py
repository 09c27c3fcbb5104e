"""Parameters of a model that misses its tests, and their covariance.

The likelihood weighs a misfit as noise of the record would be weighed: what lasts counts little,
what is steep counts much. For a misfit that is no noise, the parameters are those of plain least
squares instead, each signal over its rms misfit s_c. That is at least the median of all signals of
its quantity, so that no signal counts for most because it fits by chance. It is found by
repetition:

    minimise sum over signals |model(x) - y|^2 / s_c^2 + |(x_k - known value) / sd_k|^2.

The parameters scatter more than that minimum tells, as misfits last (Huber 1967, the sandwich;
White 1982, doi 10.2307/1912526). With J = d (model / s) / d x, and known values K,

    C = H^-1 (B + K^T K + 12 I) H^-1,    H = J^T J + K^T K + 12 I.

Curves deviate by a discrepancy of covariance D, see `pyrofit.estimate.discrepancy`. With
D / (s s^T) = W W^T,

    B = J^T J + J^T W W^T J.

D counts times from the start of a record. That of a heated sample is where somebody started the
oven, so that D is often too large. Another bound holds there: parameters hide as much misfit as is
seen. The n points of all records of a quantity then count as one observation,

    B = sum over quantities n J^T J.

The smaller variance counts. Usual errors of the apparatus add theirs, see
`pyrofit.estimate.uncertain_apparatus`.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.discrepancy import estimated, times
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.posterior import UNIFORM
from pyrofit.estimate.uncertain_apparatus import moves
from pyrofit.numerics import linear
from pyrofit.quantities.base import Quantity
from pyrofit.solver.arrays import FloatArray

MOST_POINTS = 60
"""Points of a series from which its discrepancy is estimated; it lasts over many."""
WEIGHINGS = 3
"""How often signals are weighed by their misfit."""
LEAST = 1e-6
"""Least rms misfit, as a fraction of the range of a signal."""


def least_squares(likelihood: Likelihood, x: FloatArray) -> tuple[Likelihood, FloatArray]:
    """Return the plain least squares and their minimum, from the optimum of the likelihood."""
    plain = likelihood
    for _ in range(WEIGHINGS):
        curves = likelihood.curves(x)
        if curves is None:
            break
        plain = replace(likelihood, noise=_by_misfit(likelihood, curves))
        x = plain.descend(x).x
    return plain, x


def _by_misfit(likelihood: Likelihood, curves: FloatArray) -> tuple[NoiseModel, ...]:
    """Return white noise of the size of each signal's misfit, over its weight."""
    values = [term.target.value for _, term in likelihood.problem.cost.terms]
    pairs = zip(likelihood.split(curves), values, strict=True)
    sizes = [float(np.sqrt(np.mean((curve - value) ** 2))) for curve, value in pairs]
    by_quantity: dict[str, list[float]] = {}
    names = [_quantity(likelihood, k).name for k in range(len(values))]
    for name, size, value in zip(names, sizes, values, strict=True):
        least = LEAST * max(float(np.ptp(value)), 1e-300)
        by_quantity.setdefault(name, []).append(max(size, least))
    return tuple(
        NoiseModel(
            np.full(value.size, max(size, float(np.median(by_quantity[name])))) / noise.weight,
            Correlation(),
            weight=noise.weight,
        )
        for name, size, value, noise in zip(names, sizes, values, likelihood.noise, strict=True)
    )


def _quantity(likelihood: Likelihood, channel: int) -> Quantity:
    experiment, signal, _ = likelihood.problem.picks[channel]
    return likelihood.problem.runs[experiment].experiment.quantity(signal)


def sds_of_misfit(
    likelihood: Likelihood, plain: Likelihood, x: FloatArray, slopes: FloatArray, curves: FloatArray
) -> FloatArray:
    """Return the standard deviations of the parameters, shape (parameters,).

    Parameters
    ----------
    likelihood, plain
        With the noise alone, and the least squares.
    x
        Their minimum.
    slopes, curves
        d curves / d x and the curves there, shapes (points, parameters) and (points,).
    """
    rows = plain.with_known(slopes)
    J = plain.split(rows)
    H = linear.gram(rows) + UNIFORM * np.eye(x.size)
    white = _of_discrepancy(likelihood, plain, x, slopes, curves)
    by_discrepancy = H.copy()
    for W, part in zip(white, J, strict=True):
        by_discrepancy += linear.gram(linear.product(W.T, part))
    found = _variances(H, by_discrepancy)
    quantities = [_quantity(likelihood, k) for k in range(len(J))]
    if all(quantity.against_temperature for quantity in quantities):
        found = np.minimum(found, _variances(H, _as_one_observation(H, J, quantities)))
    return np.asarray(np.sqrt(found))


def moved_by_apparatus(
    plain: Likelihood, x: FloatArray, slopes: FloatArray
) -> tuple[FloatArray, tuple[str, ...]]:
    """Return standard deviations by usual errors of the apparatus, and the largest one in words."""
    rows = plain.with_known(slopes)
    H = linear.gram(rows) + UNIFORM * np.eye(x.size)
    found = moves(plain, x)
    return found.of_parameters(plain, linear.inverse(H), rows[: sum(plain.points)])


def _variances(H: FloatArray, middle: FloatArray) -> FloatArray:
    """Return the diagonal of the sandwich."""
    half = linear.solve(H, middle)
    return np.diag(linear.solve(H, half.T))


def _of_discrepancy(
    likelihood: Likelihood, plain: Likelihood, x: FloatArray, slopes: FloatArray, curves: FloatArray
) -> list[FloatArray]:
    """Return W of each signal."""
    found = estimated(likelihood, x, slopes, curves, MOST_POINTS)
    parts = zip(found, times(likelihood), likelihood.split(curves), plain.noise, strict=True)
    return [noise.whiten(of.factor(time, curve)) for of, time, curve, noise in parts]


def _as_one_observation(
    H: FloatArray, J: Sequence[FloatArray], quantities: Sequence[Quantity]
) -> FloatArray:
    """Return the middle of the sandwich where the points of a quantity are one observation."""
    points: Counter[str] = Counter()
    for quantity, part in zip(quantities, J, strict=True):
        points[quantity.name] += len(part)
    middle = H.copy()
    for quantity, part in zip(quantities, J, strict=True):
        middle += (points[quantity.name] - 1) * linear.gram(part)
    return middle
