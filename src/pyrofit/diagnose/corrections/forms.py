"""Free corrections of a description: a handful of coefficients, zero where nothing is corrected.

The flux over time, the conductivity and the heat capacity over temperature, and the losses of front
and back over their temperatures, the same for all experiments.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from pyrofit.diagnose.corrections.flux_tables import described_at, merged, named, table_of
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.effects.base import changed, has_open_back
from pyrofit.effects.substance import properties_changed, shares
from pyrofit.estimate.problem import Outcome, Problem
from pyrofit.model.base import value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.model.slab_faces import Side
from pyrofit.model.time_table import TimeTable, at_start
from pyrofit.simulate import simulate_gasification
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.arrays import Values as Sets
from pyrofit.solver.curves import Request
from pyrofit.solver.lower_property import property_table
from pyrofit.solver.outputs import FRONT, MASS

LOSS_SD = {"gas_temperature_K": 30.0, "h_change_W_m2K": 6.0, "h_cube_root_W_m2K43": 0.8}
"""Prior standard deviations for the loss of a side, SI units, by key of the description."""
PROPERTIES = {
    "conductivity": ("conductivity_W_mK", "W/(m K)", "a conductivity that varies with temperature"),
    "heat_capacity": (
        "specific_heat_J_kgK",
        "J/(kg K)",
        "heat taken up or released at certain temperatures, as by a heat capacity that varies",
    ),
}
"""Key of the description, unit and words, by probe."""

Shape = list[tuple[float, float]]
Values = Mapping[str, float]

SAME_TERM = {
    "flux": ("flux over time", "amount of flux", "timing"),
    "conductivity": ("conductivity with temperature",),
    "heat_capacity": ("heat capacity with temperature",),
    "front_loss": ("front loss",),
    "back_loss": ("back loss",),
}
"""Groups of effects that change the same term of the model, by correction."""


@dataclass(frozen=True, eq=False)
class Correction:
    """A correction before its fit.

    ``sd`` are the standard deviations of the coefficients' priors by name. ``problem`` is the
    problem with the coefficients in its description. ``shape`` returns the curve to draw from the
    values of all parameters.
    """

    probe: str
    what: str
    unit: str
    sd: dict[str, float]
    problem: Problem
    shape: Callable[[Values], Shape]


@dataclass(frozen=True)
class _Derived(Problem):
    """A problem of which some numbers are made of the described ones and of coefficients."""

    derive: Callable[[Values], Values]

    @property
    def moving(self) -> tuple[int, ...]:
        """All positions: derived values may use each of them."""
        return tuple(range(len(self.names)))

    def outcomes(self, values: Sets, sets: int) -> list[Outcome]:
        """Return how each set ended and its models, derived values included."""
        columns = {name: np.broadcast_to(value, sets) for name, value in values.items()}
        each = [
            self.derive({name: float(column[s]) for name, column in columns.items()})
            for s in range(sets)
        ]
        made = {name: np.array([one[name] for one in each]) for name in each[0]}
        return Problem.outcomes(self, {**values, **made}, sets)


def corrections(problem: Problem, x: FloatArray) -> list[Correction]:
    """Return all corrections of a problem about fitted values x [SI]; none without gasification."""
    if not _slabs(problem):
        return []
    values = problem.values(x)
    T = _temperatures(problem, values)
    of_properties = [_property(problem, values, T, probe) for probe in PROPERTIES]
    found = [_flux(problem), *of_properties, _loss(problem, T, "front")]
    if any(has_open_back(slab) for slab in _slabs(problem).values()):
        found.append(_loss(problem, T, "back"))
    return found


def _flux(problem: Problem) -> Correction:
    """Make q(t) = q_0(t) (1 + c(t)), c linear between knots that lie closest at the start."""
    end = max(float(times[-1]) for times in _times(problem).values())
    knots = end * np.linspace(0.0, 1.0, SETTINGS.correction_coefficients) ** 2
    names = _names("flux", SETTINGS.correction_coefficients)
    described = {name: table_of(slab.front.flux_W_m2) for name, slab in _slabs(problem).items()}
    time = {name: merged(table.time_s, knots) for name, table in described.items()}
    own = {name: _names(f"flux_{i}_at", len(time[name])) for i, name in enumerate(described)}
    fronts = {
        name: {"flux_W_m2": TimeTable(time_s=time[name], value=own[name])} for name in described
    }

    def derive(values: Values) -> dict[str, float]:
        c = [values[name] for name in names]
        found: dict[str, float] = {}
        for name, table in described.items():
            q = described_at(table, time[name], values) * (1.0 + np.interp(time[name], knots, c))
            found |= zip(own[name], q.tolist(), strict=True)
        return found

    def shape(values: Values) -> Shape:
        return [(t, 1.0 + values[name]) for t, name in zip(knots.tolist(), names, strict=True)]

    return Correction(
        probe="flux",
        what="a factor on the external flux that varies over time",
        unit="-",
        sd=dict.fromkeys(names, SETTINGS.correction_flux_sd),
        problem=_derived(problem, {n: {"front": own} for n, own in fronts.items()}, derive),
        shape=shape,
    )


def _property(problem: Problem, values: Values, T: tuple[float, float], probe: str) -> Correction:
    """Make p(T) = p_0(T) + sum_k c_k exp(-((T - T_k)/w)^2/2)/(sqrt(2 pi) w), of all components."""
    key, unit, what = PROPERTIES[probe]
    names = _names(probe, SETTINGS.correction_coefficients)
    centres = np.linspace(*T, SETTINGS.correction_coefficients)
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
        at = np.linspace(*T, SETTINGS.correction_points_drawn)
        peaks = np.exp(-0.5 * (np.subtract.outer(at, centres) / width) ** 2)
        change = peaks @ [values[name] / area for name in names]
        return list(zip(at.tolist(), change.tolist(), strict=True))

    return Correction(
        probe=probe,
        what=what,
        unit=unit,
        sd=dict.fromkeys(names, SETTINGS.correction_property_sd * size * area),
        problem=replace(problem, material=material),
        shape=shape,
    )


def _loss(problem: Problem, T: tuple[float, float], side: str) -> Correction:
    """Make q = (h_0 + c_1)(T_s - T_g) + (C_0 + c_2)(T_s - T_g)^(4/3), with T_g = T_gas + c_0."""
    names = dict(zip(LOSS_SD, _names(f"{side}_loss", len(LOSS_SD)), strict=True))
    described = {name: getattr(slab, side) for name, slab in _slabs(problem).items()}
    own = {
        name: {key: named(getattr(face, key), f"probe_{side}_{key}_{i}") for key in LOSS_SD}
        for i, (name, face) in enumerate(described.items())
    }

    def derive(values: Values) -> dict[str, float]:
        return {
            str(new): value_of(old, values) + values[coefficient]
            for name, face in described.items()
            for key, coefficient in names.items()
            for new, old in zip(
                table_of(own[name][key]).value, table_of(getattr(face, key)).value, strict=True
            )
        }

    def shape(values: Values) -> Shape:
        name, face = next(iter(described.items()))
        at = np.linspace(*T, SETTINGS.correction_points_drawn)
        before = _convection(face, values, at)
        after = _convection(changed(face, **own[name]), {**values, **derive(values)}, at)
        return list(zip(at.tolist(), (after - before).tolist(), strict=True))

    return Correction(
        probe=f"{side}_loss",
        what=f"another heat loss of the {side} over its temperature",
        unit="W/m2",
        sd=dict(zip(names.values(), LOSS_SD.values(), strict=True)),
        problem=_derived(problem, {n: {side: o} for n, o in own.items()}, derive),
        shape=shape,
    )


def _convection(side: Side, values: Values, T: FloatArray) -> FloatArray:
    """Return the loss of a side by convection [W/m2], of tables at the start, the gas risen."""
    h = max(at_start(side.h_W_m2K, values) + value_of(side.h_change_W_m2K, values), 0.0)
    above = T - at_start(side.gas_temperature_K, values) - value_of(side.gas_rise_K, values)
    root = value_of(side.h_cube_root_W_m2K43, values) * np.cbrt(np.abs(above))
    return np.asarray((h + root) * above)


def _names(probe: str, count: int) -> tuple[str, ...]:
    return tuple(f"probe_{probe}_{k}" for k in range(count))


def _slabs(problem: Problem) -> dict[str, SlabExperiment]:
    found = {name: run.experiment for name, run in problem.runs.items()}
    return {name: e for name, e in found.items() if isinstance(e, SlabExperiment)}


def _times(problem: Problem) -> dict[str, FloatArray]:
    """Return the times of a record of each gasification."""
    return {
        name: next(iter(problem.runs[name].requests.values())).time_s for name in _slabs(problem)
    }


def _derived(
    problem: Problem,
    changes: Mapping[str, Mapping[str, Mapping[str, Any]]],
    derive: Callable[[Values], Values],
) -> Problem:
    """Return the problem with names in its sides, by experiment, side and key, and their values."""
    runs = dict(problem.runs)
    for name, sides in changes.items():
        slab = _slabs(problem)[name]
        for side, update in sides.items():
            slab = changed(slab, **{side: changed(getattr(slab, side), **update)})
        runs[name] = replace(runs[name], experiment=slab)
    parts = {field.name: getattr(problem, field.name) for field in fields(Problem)}
    return _Derived(**{**parts, "runs": runs}, derive=derive)


def _temperatures(problem: Problem, values: Values) -> tuple[float, float]:
    """Return the range of the sample's temperatures: from the start to the front's highest [K]."""
    low, high = [], []
    for name, slab in _slabs(problem).items():
        at = Request(_times(problem)[name])
        asked = {MASS: at, FRONT: at}
        curves = simulate_gasification(slab, problem.material, values, asked, problem.accuracy)
        mass, front = curves.signals[MASS], curves.signals[FRONT]
        present = mass >= mass[0] - SETTINGS.burnt_share * (mass[0] - mass[-1])
        low.append(value_of(slab.sample.initial_temperature_K, values))
        high.append(float(front[present].max()))
    return min(low), max(high)
