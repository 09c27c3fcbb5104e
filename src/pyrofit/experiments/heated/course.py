"""Phases of a sample that follows a temperature programme, from the simulated conversion.

*Heat-up* to 0.02, *onset* to 0.2, *main reaction* to 0.9, *end of reaction* to 0.99, *residue*.
"""

from collections.abc import Mapping

import numpy as np

from pyrofit.experiments.base import Course
from pyrofit.experiments.conversion import conversion
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_tga
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Request
from pyrofit.solver.outputs import MASS_FRACTION

PHASES = ("heat-up", "onset", "main reaction", "end of reaction", "residue")
ENDS = (0.02, 0.2, 0.9, 0.99)


def course(
    experiment: HeatedExperiment,
    material: Material,
    values: Mapping[str, float],
    request: Request,
    accuracy: Accuracy,
) -> Course:
    """Return the simulated course at the times of a request."""
    curves = simulate_tga(experiment, material, values, request, accuracy)
    return of_mass(curves.signals[MASS_FRACTION])


def of_mass(mass: FloatArray) -> Course:
    """Return the course of a heated sample from its mass, shape (n,)."""
    converted = conversion(mass)
    return Course(converted, None, np.searchsorted(ENDS, converted).astype(float), PHASES)
