"""Phases of a slab under radiant heat, from the simulated curves.

*Heat-up* lasts until the mass loss rate reaches a tenth of its largest value. *Onset* lasts until
it reaches 0.8 of its median between conversions of 0.2 and 0.8. *Plateau* lasts until the back has
warmed by a tenth of the front's rise. *Back-effect* lasts until nine tenths of the volatile mass
are gone, *burn-out* until 0.99 are. The rest is *tail*.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from pyrofit.experiments.base import Course
from pyrofit.experiments.conversion import conversion
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit.simulate import simulate_gasification
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Request
from pyrofit.solver.outputs import BACK, FRONT, MASS, RATE

_STARTED, _RISEN, _WARMED, _NEARLY, _GONE = 0.1, 0.8, 0.1, 0.9, 0.99


def course(
    experiment: SlabExperiment,
    material: Material,
    values: Mapping[str, float],
    request: Request,
    accuracy: Accuracy,
) -> Course:
    """Return the simulated course at the times of a request."""
    at = Request(request.time_s)
    requests = dict.fromkeys((RATE, MASS, FRONT, BACK), at)
    return of_curves(
        simulate_gasification(experiment, material, values, requests, accuracy).signals
    )


def of_curves(curves: Mapping[str, FloatArray]) -> Course:
    """Return the course of a slab from its curves by output, shape (n,) each."""
    rate, front, back = (curves[name] for name in (RATE, FRONT, BACK))
    X = conversion(curves[MASS])
    middle = (X > 0.2) & (X < 0.8)
    level = float(np.median(rate[middle])) if middle.any() else float(rate.max())
    if rate.max() <= 0.0:  # an inert body is heated up throughout
        return Course(X, front, np.zeros(X.size))
    started = _since(rate >= _STARTED * rate.max())
    risen = started & _since(rate >= _RISEN * level)
    warmed = _since((front > front[0]) & (back - back[0] > _WARMED * (front - front[0])))
    phase = np.zeros(X.size)
    for k, passed in enumerate((started, risen, risen & warmed, X >= _NEARLY, X >= _GONE), 1):
        phase[passed] = k
    return Course(X, front, phase)


def _since(reached: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Tell from when on something has been reached."""
    return np.asarray(np.maximum.accumulate(reached))
