"""The numbers beside the curves: agreement of the fitted signals, costs, mass."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from pyrofit.cost.distances import root_mean_square
from pyrofit.numerics import linear
from pyrofit_explore.model import ExploredModel, Simulated
from pyrofit_explore.noise import Noise


def numbers_of_set(
    model: ExploredModel, simulated: Simulated, noise: Noise | None
) -> dict[str, Any]:
    """Return the numbers of a set; held-out signals count in none of them.

    ``signals`` has the root mean square of simulated less measured values in the unit shown, and
    chi-square once the noise is known: |L^-1 (model - y) / sd|^2. ``mass`` has the released mass
    [kg/m2], simulated and measured, of records that show it. ``costs`` are those of the study; None
    where a run failed.
    """
    signals: dict[str, Any] = {}
    mass: dict[str, Any] = {}
    for i in range(model.fitted):
        name, signal = model.signals[i]
        quantity = model.study.experiments[name].quantity(signal)
        target = model.problem.cost.terms[i][1].target
        difference = simulated.models[i] - target.value
        key = f"{name}/{signal}"
        chi2 = None
        if noise is not None:
            whitened = noise[i].whiten(difference)
            chi2 = _finite(linear.dot(whitened, whitened))
        rms = _finite(quantity.shown.factor * root_mean_square(difference))
        signals[key] = {"rms": rms, "chi2": chi2, "points": target.value.size}
        if quantity.released is not None:
            both = (
                quantity.released(target.time_s, y) for y in (simulated.models[i], target.value)
            )
            mass[key] = [_finite(m) for m in both]
    return {"signals": signals, "mass": mass, "costs": _costs(model, simulated)}


def _costs(model: ExploredModel, simulated: Simulated) -> Mapping[str, float | None]:
    found = {}
    for name, places in model.costs.items():
        terms = [(model.problem.cost.terms[i], simulated.models[i]) for i in places]
        finite = all(np.isfinite(curve).all() for _, curve in terms)
        total = sum(weight * term(curve) for (weight, term), curve in terms) if finite else np.nan
        found[name] = _finite(total)
    return found


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
