"""The description of a study that the page asks for once: signals, parameters, effects."""

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pyrofit.api.choices import in_units
from pyrofit.config import Study
from pyrofit.config.resolve import diagnosed_material
from pyrofit.config.uses import parameters_in
from pyrofit.effects import known_effects
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.solver.arrays import FloatArray
from pyrofit_explore.model import ExploredModel, possible_effects

MOST_POINTS = 300
"""Points of a signal that are drawn; all count in the numbers."""
GROUPS = ("kinetics", "thermophysical properties", "apparatus")


def described_study(model: ExploredModel, bands: pd.DataFrame | None = None) -> dict[str, Any]:
    """Return signals with their measured points, parameters with their groups, and effects.

    ``bands`` are those of a posterior, as its record has them.
    """
    study = model.study
    return {
        "name": study.name,
        "title": study.title or study.name,
        "signals": [_signal(model, i, bands) for i in range(len(model.signals))],
        "parameters": _parameters(study, model.problem.names),
        "effects": _effects(study),
        "costs": list(model.costs),
        "middle": in_units(study, middle(model)),
    }


def middle(model: ExploredModel) -> dict[str, float]:
    """Return the middle of the limits, and known and given values instead where there are any."""
    study, problem = model.study, model.problem
    centre = 0.5 * (problem.lower + problem.upper)
    values = dict(zip(problem.names, centre.tolist(), strict=True))
    known = {n: k.value * study.parameters[n].factor for n, k in study.known.items() if n in values}
    given = {n: v for n, v in study.fixed_values().items() if n in values}
    return values | given | known


@cache
def drawn_points(size: int) -> NDArray[np.int64]:
    """Return the positions of the points that are drawn of a record of some size.

    >>> drawn_points(3).tolist(), drawn_points(1000).size
    ([0, 1, 2], 300)
    """
    return np.unique(np.linspace(0, size - 1, min(size, MOST_POINTS)).round().astype(int))


def in_shown_units(model: ExploredModel, channel: int, curve: FloatArray) -> FloatArray:
    """Return the drawn points of a curve in the unit in which its quantity is shown."""
    name, signal = model.signals[channel]
    shown = model.study.experiments[name].quantity(signal).shown
    return np.asarray(shown.factor * curve[drawn_points(curve.size)] + shown.offset)


def _signal(model: ExploredModel, channel: int, bands: pd.DataFrame | None) -> dict[str, Any]:
    name, signal = model.signals[channel]
    experiment = model.study.experiments[name]
    quantity = experiment.quantity(signal)
    target = model.problem.cost.terms[channel][1].target
    at = drawn_points(target.time_s.size)
    temperature = model.problem.temperature_K(channel)
    heated = quantity.against_temperature and temperature is not None
    x = temperature - ICE_POINT_K if heated and temperature is not None else target.time_s
    sd = target.uncertainty
    return {
        "id": f"{name}/{signal}",
        "experiment": name,
        "title": experiment.title or name,
        "quantity": experiment.words(signal),
        "unit": quantity.shown.unit,
        "difference": "K" if quantity.is_temperature else quantity.shown.unit,
        "abscissa": "temperature [°C]" if heated else "time [s]",
        "x": _rounded(x[at]),
        "measured": _rounded(in_shown_units(model, channel, target.value)),
        "sd": None if sd is None else _rounded(quantity.shown.factor * sd[at]),
        "fitted": channel < model.fitted,
        "band": None if bands is None else _band(model, channel, bands),
    }


def _band(model: ExploredModel, channel: int, bands: pd.DataFrame) -> list[list[float]] | None:
    """Return lower and upper end of the band of the posterior at the drawn points."""
    name, signal = model.signals[channel]
    own = bands[(bands["experiment"] == name) & (bands["signal"] == signal)]
    if own.empty:
        return None
    shown = model.study.experiments[name].quantity(signal).shown
    time = model.problem.cost.terms[channel][1].target.time_s
    at = time[drawn_points(time.size)]
    ends = (np.interp(at, own["time_s"], own[end]) for end in ("low", "high"))
    return [_rounded(shown.factor * end + shown.offset) for end in ends]


def _rounded(values: FloatArray) -> list[float]:
    return [float(f"{v:.5g}") for v in values.tolist()]


def _parameters(study: Study, names: tuple[str, ...]) -> list[dict[str, Any]]:
    own = set(study.kinetics.estimate) if study.kinetics else set()
    of_material = parameters_in(diagnosed_material(study))
    found = []
    for name in names:
        p, known = study.parameters[name], study.known.get(name)
        group = 0 if name in own else 1 if name in of_material else 2
        found.append(
            {
                "name": name,
                "label": p.label or name,
                "unit": p.unit,
                "lower": p.lower,
                "upper": p.upper,
                "known": None if known is None else {"value": known.value, "sd": known.sd},
                "group": GROUPS[group],
            }
        )
    return sorted(found, key=lambda p: GROUPS.index(p["group"]))


def _effects(study: Study) -> list[dict[str, Any]]:
    catalogue: Mapping[str, Any] = known_effects()
    return [
        {
            "name": name,
            "title": effect.title,
            "equation": effect.equation,
            "group": effect.group,
            "family": effect.family,
            "numbers": [
                {
                    "name": f"{name}_{key}",
                    "label": q.label,
                    "symbol": q.symbol,
                    "unit": q.unit,
                    "lower": q.lower,
                    "upper": q.upper,
                    "start": q.typical if key in effect.strength else q.value,
                    "strength": key in effect.strength,
                }
                for key, q in effect.quantities.items()
            ],
        }
        for name in possible_effects(study)
        for effect in [catalogue[name]]
    ]
