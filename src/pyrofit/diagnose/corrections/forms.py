"""Free corrections of a description: a handful of coefficients, zero where nothing is corrected.

They change the flux over time, conductivity and heat capacity over temperature, the losses of front
and back, or the heat capacity of the foil. They are the same for all experiments.
"""

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.corrections.correction import Correction, Values, slabs_of, times_of_record
from pyrofit.diagnose.corrections.flux import flux
from pyrofit.diagnose.corrections.foil import foil_capacity
from pyrofit.diagnose.corrections.losses import loss
from pyrofit.diagnose.corrections.properties import PROPERTIES, of_property
from pyrofit.effects.base import has_foil, has_open_back
from pyrofit.estimate.problem import Problem
from pyrofit.model.base import value_of
from pyrofit.simulate import simulate_gasification
from pyrofit.solver.curves import Request
from pyrofit.solver.outputs import FRONT, MASS

SAME_TERM = {
    "flux": ("flux over time", "amount of flux", "timing"),
    "conductivity": ("conductivity with temperature",),
    "heat_capacity": ("heat capacity with temperature",),
    "front_heat_loss": ("front loss",),
    "back_heat_loss": ("back loss",),
    "foil_heat_capacity": ("heat capacity of the foil",),
}
"""Groups of effects that change the same term of the model, by correction."""


def fitted_corrections(trial: FittedModel) -> list[Correction]:
    """Return all corrections of a model about its fit; none without gasification."""
    problem, settings = trial.model.likelihood.problem, trial.settings
    if not slabs_of(problem):
        return []
    values = problem.values(trial.model.likelihood.values(trial.fit.x))
    ends = _temperatures(problem, values, settings.burnt_share)
    T = np.linspace(*ends, settings.correction_points_drawn)
    count, sd = settings.correction_coefficients, settings.correction_property_sd
    of_properties = [of_property(problem, values, T, probe, count, sd) for probe in PROPERTIES]
    first = flux(problem, count, settings.correction_flux_sd)
    found = [first, *of_properties, loss(problem, T, "front")]
    if any(has_open_back(slab) for slab in slabs_of(problem).values()):
        found.append(loss(problem, T, "back"))
    if any(map(has_foil, slabs_of(problem).values())):
        found.append(foil_capacity(problem, ends))
    return found


def _temperatures(problem: Problem, values: Values, burnt: float) -> tuple[float, float]:
    """Return the range of the sample's temperatures: from the start to the front's highest [K].

    That of the front does not count after the share ``burnt`` of the lost mass.
    """
    low, high = [], []
    for name, slab in slabs_of(problem).items():
        at = Request(times_of_record(problem)[name])
        asked = {MASS: at, FRONT: at}
        curves = simulate_gasification(slab, problem.material, values, asked, problem.accuracy)
        mass, front = curves.signals[MASS], curves.signals[FRONT]
        present = mass >= mass[0] - burnt * (mass[0] - mass[-1])
        low.append(value_of(slab.sample.initial_temperature_K, values))
        high.append(float(front[present].max()))
    return min(low), max(high)
