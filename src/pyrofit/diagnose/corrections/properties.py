"""Properties of all components that vary with temperature in another way."""

from dataclasses import replace

import numpy as np

from pyrofit.diagnose.corrections.correction import Correction, Shape, Values, coefficient_names
from pyrofit.effects.substance import properties_changed, shares
from pyrofit.estimate.problem import Problem
from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.lower_property import property_table

PROPERTIES = {
    "conductivity": ("conductivity_W_mK", "W/(m K)", "a conductivity that varies with temperature"),
    "heat_capacity": (
        "specific_heat_J_kgK",
        "J/(kg K)",
        "a heat capacity that varies with temperature",
    ),
}
"""Key of the description, unit and words, by probe."""


def of_property(
    problem: Problem, values: Values, T: FloatArray, probe: str, count: int, sd: float
) -> Correction:
    """Make p(T) = p_0(T) + sum_k c_k exp(-((T - T_k)/w)^2/2)/(sqrt(2 pi) w), of all components.

    It has ``count`` coefficients. ``sd`` is the prior standard deviation of the change, relative to
    the median of p_0. The correction is drawn at the temperatures T.
    """
    key, unit, what = PROPERTIES[probe]
    names = coefficient_names(probe, count)
    centres = np.linspace(T[0], T[-1], count)
    width = 0.5 * float(centres[1] - centres[0])
    area = width * float(np.sqrt(2.0 * np.pi))
    peak = properties_changed(key, peak_area="c", peak_temperature_K="T", peak_width_K="w")
    material = problem.material
    for name, centre in zip(names, centres.tolist(), strict=True):
        material = peak(material, {"c": name, "T": centre, "w": width}, material.own)
    share = shares(problem.material)
    main = problem.material.components[max(share, key=lambda name: share[name])]
    size = float(np.median(property_table(getattr(main, key), values)))

    def shape(values: Values) -> Shape:
        peaks = functions.exp(-0.5 * (np.subtract.outer(T, centres) / width) ** 2)
        change = linear.product(peaks, [values[name] / area for name in names])
        return list(zip(T.tolist(), change.tolist(), strict=True))

    return Correction(
        probe=probe,
        what=what,
        unit=unit,
        sd=dict.fromkeys(names, sd * size * area),
        problem=replace(problem, material=material),
        shape=shape,
    )
