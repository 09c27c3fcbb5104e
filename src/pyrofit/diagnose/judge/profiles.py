"""How chi-square rises with the strength of each effect of a model, all else at its best."""

from functools import partial

import numpy as np

from pyrofit.constants import QUANTILE
from pyrofit.diagnose.base.descent import descend_chi_square
from pyrofit.diagnose.base.fitted import FittedModel, up_to_date
from pyrofit.diagnose.base.model import strength_of
from pyrofit.estimate.profile import profile_of
from pyrofit.parallel import parallel_map
from pyrofit.results.diagnosis_schema import OfProfile


def profiles(trial: FittedModel, processes: int = 1) -> list[OfProfile]:
    """Return the profile of each effect's strength, SI units, and its 95 % interval.

    ``rise`` is that of chi-square over its least value, negative where a profile met a lower one.
    The interval ends where it is 3.84 times chi-square per degree of freedom (``level``). It is
    open where the limit comes before.
    """
    trial = up_to_date(trial)
    effects = trial.effects
    return parallel_map(lambda k: _profile(trial, effects[k]), len(effects), processes)


def _profile(trial: FittedModel, effect: str) -> OfProfile:
    model, fit = trial.model, trial.fit
    i, (parameter, quantity) = model.position(effect), strength_of(effect)
    posterior = trial.posterior
    C, dispersion = posterior.covariance(), posterior.dispersion
    found, _ = profile_of(
        partial(descend_chi_square, model),
        fit,
        i,
        C[:, i] / C[i, i],
        float(np.sqrt(C[i, i])),
        dispersion,
    )
    within = found.interval(dispersion)

    def value(x: float) -> float:
        return float(quantity.lower + x * (quantity.upper - quantity.lower))

    return OfProfile(
        effect=effect,
        parameter=parameter,
        unit=quantity.unit,
        value=[value(x) for x in found.x],
        rise=[float(rise) for rise in found.rise],
        level=QUANTILE**2 * dispersion,
        low=value(within.low),
        high=value(within.high),
        low_open=within.low_open,
        high_open=within.high_open,
    )
