"""Scaling pyrolysis of FDS: reference curves of gasification in place of kinetics.

The heat release of a reference test is the mass loss rate times the heat of combustion, over the
time since ignition. Tests in an inert gas have no flame: INERT_Q_REF says so to FDS.
"""

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.solver.arrays import FloatArray
from pyrofit_exchange.fds.layers import layer_keys, own_layers
from pyrofit_exchange.fds.materials import MaterialLines, Options, Values, write_materials
from pyrofit_exchange.fds.namelists import Item, Namelist
from pyrofit_exchange.fds.predicted import BURNT_KG_M2S
from pyrofit_exchange.fds.versions import NEW, FdsError

MOST_CURVES = 10
"""Reference curves that a SURF line takes."""
EVERY_S = 5.0


class ReferenceTest(NamedTuple):
    """A reference test.

    Parameters
    ----------
    experiment
        Its name.
    flux_W_m2, thickness_m
        External flux and thickness of the sample.
    time_s, rate
        Mass loss rate [kg/(m2 s)] over time.
    """

    experiment: str
    flux_W_m2: float
    thickness_m: float
    time_s: FloatArray
    rate: FloatArray


def ignition(curve: ReferenceTest) -> float:
    """Return the first time [s] at which the rate is 1 g/(m2 s).

    Raises
    ------
    FdsError
        The sample loses no mass.
    """
    above = np.flatnonzero(curve.rate >= BURNT_KG_M2S)
    if not above.size:
        raise FdsError(f"{curve.experiment}: no mass loss rate of 1 g/(m2 s); leave this test out")
    return float(curve.time_s[above[0]])


def ramp(curve: ReferenceTest, name: str, heat_J_kg: float) -> list[Namelist]:
    """Return the heat release [kW/m2] over the time since ignition, means over 5 s."""
    since = curve.time_s - ignition(curve)
    edges = np.arange(0.0, float(since[-1]) + EVERY_S, EVERY_S)
    points = []
    for begin, end in itertools.pairwise(edges):
        inside = (since >= begin) & (since < end)
        if inside.any():
            mean = max(float(np.mean(curve.rate[inside])), 0.0)
            points.append((0.5 * (begin + end), 1e-3 * heat_J_kg * mean))
    points = [(0.0, points[0][1]), *points, (float(edges[-1]) + EVERY_S, 0.0)]
    return [Namelist("RAMP", {"ID": name, "T": t, "F": q}) for t, q in points]


def scaling_lines(
    name: str,
    curves: Sequence[ReferenceTest],
    experiment: SlabExperiment,
    material: Material,
    values: Values,
    ignition_K: float,
    heat_J_kg: float,
) -> list[Namelist]:
    """Return MATL, RAMP and SURF lines of scaling pyrolysis.

    Parameters
    ----------
    name
        Identifier of the surface.
    curves
        Reference tests, 10 at most.
    experiment, material, values
        A slab whose front layer is the material; its components do not react here.
    ignition_K
        Temperature of the surface at ignition.
    heat_J_kg
        Heat of combustion of the gas.

    Raises
    ------
    FdsError
        There is no curve, or there are too many.
    """
    if not 0 < len(curves) <= MOST_CURVES:
        raise FdsError(f"{len(curves)} reference curves; FDS takes 1 to {MOST_CURVES}")
    inert = material.model_copy(update={"reactions": {}})
    layer = own_layers(experiment.sample, material, values)[:1]
    lines: MaterialLines = write_materials(inert, values, list(layer[0].shares), Options(NEW))
    names = [f"Q_{n + 1}" for n in range(len(curves))]
    several = f"(1:{len(curves)})" if len(curves) > 1 else ""
    items: dict[str, Item | Sequence[Item]] = {
        "ID": name,
        **layer_keys(layer, lines),
        "HRRPUA": 1.0,
        "IGNITION_TEMPERATURE": round(ignition_K - ICE_POINT_K, 2),
        f"RAMP_Q{several}": names,
        f"REFERENCE_HEAT_FLUX{several}": [1e-3 * c.flux_W_m2 for c in curves],
        f"REFERENCE_THICKNESS{several}": [c.thickness_m for c in curves],
        "INERT_Q_REF": True,
    }
    ramps = [line for c, n in zip(curves, names, strict=True) for line in ramp(c, n, heat_J_kg)]
    return [*lines.namelists, *ramps, Namelist("SURF", items)]
