"""A kind of experiment whose sample is a slab under radiant heat."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from pyrofit.experiments.base import Course, Designs, Kind
from pyrofit.experiments.conversion import conversion
from pyrofit.experiments.from_files import FromFiles
from pyrofit.experiments.slab.simulate import reference, request, synthetic
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit.simulate import simulate_gasification, simulate_slabs
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


def slab_kind(description: type[SlabExperiment], designs: Designs, files: FromFiles) -> Kind:
    """Return a kind with the solvers and phases that all slabs share."""
    return Kind(
        description=description,
        words=description.APPARATUS,
        stage="imp",
        simulate=simulate_slabs,
        reference=reference,
        request=request,
        synthetic=synthetic,
        course=course,
        designs=designs,
        files=files,
    )
