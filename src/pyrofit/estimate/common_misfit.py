"""Misfit that all repeats of a test share, tested against what they differ by.

Scatter between repeats widens their noise, and two repeats tell its size badly. A misfit that each
shows alone must not pass as such scatter. With R residuals r_k, averaged over blocks of the record,
P projects on what no other level, stretch and start of the record makes. Then

    F = R |P mean r|^2 / (sum_k |P (r_k - mean r)|^2 / (R - 1) + trace(P V P))

has Fisher's distribution with n and n (R - 1) degrees of freedom at most, if the repeats scatter
about the model. V is the covariance of the noise of one record without that scatter. Differences of
repeats last over some blocks, so that n is half of the directions that P leaves.
"""

from collections.abc import Sequence

import numpy as np
from scipy.special import fdtrc

from pyrofit.estimate.between_repeats import groups_of_repeats, record_of, usual_changes
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

BLOCKS, FEWEST = 20, 8
"""Blocks of a record, each of one mean, and how many all repeats must share for a test."""


def p_of_repeats(likelihood: Likelihood, curves: FloatArray) -> list[tuple[Sequence[int], float]]:
    """Return the channels that repeat one signal, and how probably scatter makes such a misfit.

    Parameters
    ----------
    likelihood
        The signals with their noise.
    curves
        The simulated channels, one after the other, shape (points,).
    """
    parts = likelihood.split(curves)
    groups = groups_of_repeats(likelihood.problem)
    return [(group, _p_of(likelihood, group, parts)) for group in groups]


def _p_of(likelihood: Likelihood, group: Sequence[int], curves: Sequence[FloatArray]) -> float:
    noise = [likelihood.noise[k].alone for k in group]
    pairs = zip(group, noise, strict=True)
    records = [record_of(likelihood.problem, k, own, curves) for k, own in pairs]
    middle, averages = _blocks([record.at for record in records])
    if middle.size < FEWEST:
        return 1.0
    means = [linear.product(a, r.value) for a, r in zip(averages, records, strict=True)]
    usual = usual_changes(middle, np.mean(means, axis=0), records[0].usual)
    left = middle.size - len(usual)
    Q, _ = linear.qr(usual.T)
    rest = np.eye(middle.size) - linear.product(Q, Q.T)
    of_blocks = [
        mean - linear.product(a, r.about)
        for a, r, mean in zip(averages, records, means, strict=True)
        if r.about is not None
    ]
    residuals = linear.product(rest, np.column_stack(of_blocks))
    pairs_of = zip(averages, noise, strict=True)
    V = np.mean([linear.product(a, n.covariance_with(a.T)) for a, n in pairs_of], axis=0)
    common, freedom = residuals.mean(axis=1), len(group) - 1
    scatter = float(np.sum((residuals - common[:, None]) ** 2)) / freedom
    scatter += float(np.sum(rest * V))  # trace(P V P), as P P = P
    ratio = len(group) * linear.dot(common, common) / max(scatter, 1e-300)
    return float(fdtrc(0.5 * left, 0.5 * left * freedom, ratio))


def _blocks(abscissae: Sequence[FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    """Return the middles of the blocks that all records have, and the weights of their means.

    The shapes are (blocks,), and (blocks, n) for each record.
    """
    low, high = max(at.min() for at in abscissae), min(at.max() for at in abscissae)
    edges = np.linspace(low, high, BLOCKS + 1)
    inside = [(at >= edges[:-1, None]) & (at <= edges[1:, None]) for at in abscissae]
    full = np.all([own.any(axis=1) for own in inside], axis=0)
    middle = 0.5 * (edges[1:] + edges[:-1])
    return middle[full], [own[full] / own[full].sum(axis=1, keepdims=True) for own in inside]
