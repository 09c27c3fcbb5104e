"""How much of the weight of all fitted models has an effect of a group.

A search ends at one of several models that fit almost equally well; another start or another
processor may end at the next one. Each model m that was fitted has the weight of its penalised
chi-square, with the price of choosing its effects among M candidates,

    w_m = exp(-(chi2_m / f + log(n) parameters_m + 2 log(M) effects_m) / 2),

f the inflation by misfit. The weight of a group is the share of the models that have an effect of
it (model averaging: Hoeting et al. 1999, doi 10.1214/ss/1009212519).
"""

import numpy as np

from pyrofit.diagnose.judge.inflation import inflation_by_misfit
from pyrofit.diagnose.search.restart import best_of_each
from pyrofit.diagnose.search.stepwise import Search
from pyrofit.effects import known_effects
from pyrofit.numerics import functions


def group_weights(found: Search) -> dict[str, float]:
    """Return the weight of each group of effects of the fitted models, the largest first."""
    penalised, catalogue = inflation_by_misfit(found).penalised, known_effects()
    models = best_of_each([found.end, found.base, *found.trials])
    costs = np.array([penalised(m) + found.spare * len(m.effects) for m in models])
    weights = functions.exp(-0.5 * (costs - costs.min()))
    groups: dict[str, float] = {}
    for model, weight in zip(models, (weights / weights.sum()).tolist(), strict=True):
        for group in dict.fromkeys(catalogue[effect].group for effect in model.effects):
            groups[group] = groups.get(group, 0.0) + weight
    return dict(sorted(groups.items(), key=lambda one: -one[1]))
