"""Disturbed data: measured values changed by a small part of their noise."""

from dataclasses import replace

import numpy as np

from pyrofit.cost import WeightedSum, make_term
from pyrofit.cost.term import Term
from pyrofit.data.noise import draw_noise
from pyrofit.diagnose.base.model import Base
from pyrofit.estimate.noise import NoiseModel
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray


def disturbed(base: Base, seed: int) -> Base:
    """Return the base with y + s e in the place of the measured values y of all channels.

    e is a draw of the noise as it is estimated, correlation included, and s is
    the setting ``disturbance``. The variance of the noise rises by the factor 1 + s^2 only, so that
    the error rates of the tests hardly change.

    Parameters
    ----------
    base
        The base with its noise.
    seed
        Seed of the draw.
    """
    rng, share = np.random.default_rng(seed), base.settings.disturbance
    problem = base.likelihood.problem
    pairs = zip(problem.cost.terms, base.likelihood.noise, strict=True)
    terms = [(weight, _disturbed(term, noise, share, rng)) for (weight, term), noise in pairs]
    problem = replace(problem, cost=WeightedSum(terms))
    return replace(base, likelihood=replace(base.likelihood, problem=problem))


def _disturbed(term: Term, noise: NoiseModel, share: float, rng: np.random.Generator) -> Term:
    value = term.target.value + share * drawn(noise, rng)
    return make_term(term.kind, replace(term.target, value=value), **term.options)


def drawn(noise: NoiseModel, rng: np.random.Generator) -> FloatArray:
    """Return a draw of the noise of a series, shape (n,), in its unit.

    e = sd L z + U u, with the autocorrelation L L^T, the lasting scatter U between repeats, and
    standard normal z and u.
    """
    e = noise.sd * draw_noise(noise.correlation.sequence(noise.sd.size), rng)
    if noise.modes is not None:
        e = e + linear.product(noise.modes, rng.standard_normal(noise.modes.shape[1]))
    return np.asarray(e)
