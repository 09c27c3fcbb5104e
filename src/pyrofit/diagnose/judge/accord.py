"""Whether an effect is in accord with the known values of parameters.

An effect may gain only because it moves known values away from what was measured independently.
Then it stands for something else. Where it does move them, both models are fitted once more with
the known values held, and the effect must gain enough there, too.

The other way round, a known value may be wrong, and an effect may stand for its error. Where the
model without the effect strains at known values, it is fitted once more without these.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.descent import descend_chi_square
from pyrofit.diagnose.base.fit import refitted
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import model_of
from pyrofit.estimate.prior import NormalPrior
from pyrofit.numerics import functions
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray

Pair = tuple[FittedModel, FittedModel]
"""A model with an effect, and the one without it."""


def deviations(trial: FittedModel) -> FloatArray:
    """Return known parameters less their known values, in stated standard deviations."""
    prior = trial.model.likelihood.prior
    values = trial.model.likelihood.values(trial.fit.x)[None]
    return np.asarray(prior.residuals(values)[0] / prior.weight)


def known_beside(own: FittedModel, without: FittedModel) -> dict[str, tuple[float, float]]:
    """Return the deviations without and with an effect, of parameters that some fit moves."""
    names, index = own.model.names, own.model.likelihood.prior.index
    both = zip(index, deviations(without).tolist(), deviations(own).tolist(), strict=True)
    idle = own.model.idle
    return {names[i]: (before, after) for i, before, after in both if i not in idle}


def moved_away(own: FittedModel, without: FittedModel) -> list[str]:
    """Return the parameters that an effect moves away from their known values."""
    after, before = np.abs(deviations(own)), np.abs(deviations(without))
    names, settings = own.model.names, own.settings
    far = (after > settings.far_from_known) & (after > before + settings.moved_from_known)
    index = own.model.likelihood.prior.index
    return [names[i] for i, is_far in zip(index, far, strict=True) if is_far]


def conflicts(
    pairs: Sequence[Pair],
    penalised: Callable[[FittedModel], float],
    enough: float,
    processes: int = 1,
) -> list[list[str]]:
    """Return the known parameters that each effect must move away to gain enough; none: accord.

    Parameters
    ----------
    pairs
        Models with and without an effect.
    penalised
        Chi-square of a model with the price of its parameters.
    enough
        Fall of it that a claim needs.
    """
    moved = [moved_away(*pair) for pair in pairs]
    asked = [k for k, names in enumerate(moved) if names]
    fits = parallel_map(lambda i: _held(pairs[asked[i // 2]][i % 2]), 2 * len(asked), processes)
    found: list[list[str]] = [[] for _ in pairs]
    for k, own, without in zip(asked, fits[::2], fits[1::2], strict=True):
        if penalised(without) - penalised(own) < enough:
            found[k] = moved[k]
    return found


def wrong_instead(
    pairs: Sequence[Pair],
    penalised: Callable[[FittedModel], float],
    near: float,
    processes: int = 1,
) -> list[list[str]]:
    """Return the known values whose error would explain as much as each effect, if there are any.

    Parameters
    ----------
    pairs
        Models with and without an effect.
    penalised
        Chi-square of a model with the price of its parameters.
    near
        Rise of it within which two models cannot be told apart.
    """
    strained = [_strained(without) for _, without in pairs]
    asked = [k for k, names in enumerate(strained) if names]
    fits = parallel_map(
        lambda i: _without_known(pairs[asked[i]][1], strained[asked[i]]), len(asked), processes
    )
    found: list[list[str]] = [[] for _ in pairs]
    for k, freed in zip(asked, fits, strict=True):
        price = len(strained[k]) * float(functions.log(freed.model.points))
        if penalised(freed) + price <= penalised(pairs[k][0]) + near:
            found[k] = strained[k]
    return found


def _strained(trial: FittedModel) -> list[str]:
    """Return the parameters that a fit moves far away from their known values."""
    far = np.abs(deviations(trial)) > trial.settings.far_from_known
    index = trial.model.likelihood.prior.index
    return [trial.model.names[i] for i, is_far in zip(index, far, strict=True) if is_far]


def _without_known(trial: FittedModel, names: Sequence[str]) -> FittedModel:
    """Return a model fitted without some known values, within wide limits about these."""
    base, prior = trial.model.base, trial.model.base.likelihood.prior
    problem = base.likelihood.problem
    freed = np.array([problem.names[i] in names for i in prior.index])
    index = np.array(prior.index)
    reach = trial.settings.widest_known * prior.sd * prior.weight
    # A property stays above zero.
    reach = np.where(prior.mean > 0.0, np.minimum(reach, 0.9 * prior.mean), reach)
    lower, upper = problem.lower.copy(), problem.upper.copy()
    at = index[freed]
    lower[at] = np.minimum(lower[at], (prior.mean - reach)[freed])
    upper[at] = np.maximum(upper[at], (prior.mean + reach)[freed])
    known = NormalPrior(
        tuple(index[~freed].tolist()),
        prior.mean[~freed],
        prior.sd[~freed],
        np.broadcast_to(prior.weight, freed.shape)[~freed],
    )
    problem = replace(problem, lower=lower, upper=upper)
    likelihood = replace(base.likelihood, problem=problem, prior=known)
    model = model_of(
        replace(base, likelihood=likelihood), trial.model.effects, trial.model.channels
    )
    x = model.likelihood.scaled(trial.model.likelihood.values(trial.fit.x))
    return FittedModel(model, descend_chi_square(model, x))


def _held(trial: FittedModel) -> FittedModel:
    """Return a model fitted with its known values held."""
    base = trial.model.base
    prior = base.likelihood.prior
    prior = prior.over(trial.settings.held_known / prior.weight)
    return refitted(trial, replace(base, likelihood=replace(base.likelihood, prior=prior)))
