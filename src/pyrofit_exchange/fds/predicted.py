"""pyrofit's curves of the same experiments, for comparison with FDS."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from pyrofit.model.accuracy import Accuracy
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit.simulate import simulate_gasification, simulate_tga
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Request
from pyrofit.solver.outputs import BACK, FRONT, MASS, MASS_FRACTION, RATE
from pyrofit_exchange.fds.materials import Values
from pyrofit_exchange.fds.versions import FdsError

LONGEST_S = 7200.0
"""Longest test that is written."""
AFTER_S = 70.0
"""Time that a deck runs on behind burn-out."""
BURNT_KG_M2S = 1e-3
"""Burn-out is the last time at which the mass loss rate falls through this."""
LAST_K = 1200.0


class PredictedByPyrofit(NamedTuple):
    """Curves of pyrofit at intervals of 1 s, means over them of the rate, shape (n,).

    Parameters
    ----------
    time_s
        Middle of the intervals.
    rate, back_K, front_K, mass
        Mass loss rate [kg/(m2 s)], temperatures, mass per area [kg/m2].
    burn_out_s
        Time of burn-out; NaN where there is none.
    end_s
        End of the test that is written.
    """

    time_s: FloatArray
    rate: FloatArray
    back_K: FloatArray
    front_K: FloatArray
    mass: FloatArray
    burn_out_s: float
    end_s: float


def burn_out(time_s: FloatArray, rate: FloatArray) -> float:
    """Return the last time at which the rate falls through the limit, NaN without one.

    >>> round(burn_out(np.array([0.0, 1.0, 2.0]), np.array([0.0, 2e-3, 0.0])), 3)
    1.5
    """
    falls = np.flatnonzero((rate[:-1] >= BURNT_KG_M2S) & (rate[1:] < BURNT_KG_M2S))
    if not falls.size:
        return float("nan")
    n = int(falls[-1])
    part = (rate[n] - BURNT_KG_M2S) / (rate[n] - rate[n + 1])
    return float(time_s[n] + part * (time_s[n + 1] - time_s[n]))


def predict_slab(
    experiment: SlabExperiment, material: Material, values: Values, accuracy: Accuracy
) -> PredictedByPyrofit:
    """Return pyrofit's curves until 70 s behind burn-out, without the effects of recording.

    Raises
    ------
    FdsError
        The simulation does not finish.
    """
    plain = experiment.model_copy(update={"signals": {}})
    longest = max(1800.0, experiment.duration_s)
    while True:
        at = np.arange(0.5, longest, 1.0)
        names = {RATE: Request(at, 1.0), **{n: Request(at) for n in (BACK, FRONT, MASS)}}
        run = simulate_gasification(plain, material, values, names, accuracy)
        if not run.status.finished:
            raise FdsError(f"no curve to compare FDS with: {run.status.explanation}")
        burnt = burn_out(at, run.signals[RATE])
        if burnt + AFTER_S < longest or longest >= LONGEST_S:
            break
        longest = min(2.0 * longest, LONGEST_S)
    end = min(np.ceil(burnt + AFTER_S), longest) if np.isfinite(burnt) else longest
    kept = at < end
    rate, back, front, mass = (run.signals[n][kept] for n in (RATE, BACK, FRONT, MASS))
    return PredictedByPyrofit(at[kept], rate, back, front, mass, burnt, float(end))


def predict_heated(
    experiment: HeatedExperiment, material: Material, values: Values, accuracy: Accuracy
) -> Callable[[FloatArray], FloatArray]:
    """Return the mass fraction over the sample's temperature [K], at the nominal heating rate."""
    first = experiment.start_temperature_K
    rate = experiment.heating_rate_K_min / 60.0
    T = np.arange(first, LAST_K + 0.1, 0.5)
    plain = experiment.model_copy(update={"signals": {}, "lag_s": 0.0, "temperature_offset_K": 0.0})
    request = Request((T - first) / rate, temperature_K=T, output=MASS_FRACTION)
    run = simulate_tga(plain, material, values, request, accuracy)
    if not run.status.finished:
        raise FdsError(f"no curve to compare FDS with: {run.status.explanation}")
    mass = run.signals[MASS_FRACTION]
    return lambda at: np.asarray(np.interp(at, T, mass))
