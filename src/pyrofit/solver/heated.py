"""Small samples that follow temperature programmes: mass, heat flow, heat release."""

import itertools
from collections.abc import Collection, Mapping, Sequence

import numpy as np

from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.solver.arrays import FloatArray, Network, Status, Values
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.lower import fractions
from pyrofit.solver.lower_network import is_separate, lower_network
from pyrofit.solver.lower_property import property_at, stack, total
from pyrofit.solver.outputs import FRACTION_RATE, HEAT_FLOW, HEAT_RELEASE, MASS_FRACTION
from pyrofit.solver.run_heated import Heated, Programs, heat

COUPLED_STEP = 0.125
"""Temperature step over that of separate reactions, where one feeds or starves another."""


def heated_samples(
    experiments: Sequence[HeatedExperiment],
    material: words.Material,
    values: Values,
    requests: Sequence[Request],
    wanted: Sequence[Collection[str]],
    step_K: float,
    sets: int = 1,
) -> list[list[Curves]]:
    """Return the curves by request, then by set; in one call of the kernel for each gas.

    Per initial mass, with the sample's temperature T, the line b0 + b1 (T - T_ref), the gas gamma_j
    per kg of reactant and its heat of combustion dhc_j:

        heat flow = sum_i m_i c_i(T) dT/dt + sum_j dh_j r_j + b0 + b1 (T - T_ref),
        heat release: tau dy/dt = sum_j gamma_j dhc_j r_j - y.

    Parameters
    ----------
    experiments, requests
        Of each request its experiment; times [s] and temperatures [K], shape (points,).
    material, values
        The description; each value is a number or has the shape (sets,).
    wanted
        Of each request the names of its curves; mass fraction and rate come in any case.
    step_K
        Largest temperature rise of a step [K].
    sets
        Number of parameter sets.
    """
    curves: list[list[Curves]] = [[] for _ in experiments]
    for oxygen, at in _by_gas(experiments, material).items():
        own, asked = [experiments[p] for p in at], [requests[p] for p in at]
        names = [wanted[p] for p in at]
        found = _in_one_gas(own, material, values, asked, names, step_K, sets, oxygen)
        for p, of_sets in zip(at, found, strict=True):
            curves[p] = of_sets
    return curves


def _by_gas(
    experiments: Sequence[HeatedExperiment], material: words.Material
) -> dict[float | str, list[int]]:
    """Return the positions of the experiments by the oxygen in their gas, where that matters."""
    if not material.oxidises:
        return {0.0: list(range(len(experiments)))}
    places: dict[float | str, list[int]] = {}
    for p, experiment in enumerate(experiments):
        places.setdefault(experiment.oxygen, []).append(p)
    return places


def _in_one_gas(
    experiments: Sequence[HeatedExperiment],
    material: words.Material,
    values: Values,
    requests: Sequence[Request],
    wanted: Sequence[Collection[str]],
    step_K: float,
    sets: int,
    oxygen: float | str,
) -> list[list[Curves]]:
    """Return the curves as `heated_samples` does, from one call of the kernel."""
    programs, rises = _programs(requests, wanted)
    flows, burns = programs.wanted.T
    network = lower_network(material, values, sets, bool(flows.any()), bool(burns.any()), oxygen)
    lags = _lags(experiments, values, sets)
    found = heat(
        programs,
        lags,
        fractions(material.composition, list(material.components), values, sets),
        network,
        step_K * np.where(is_separate(network), 1.0, COUPLED_STEP),
        (network.gas * network.combustion + network.glow, _responses(experiments, values, sets)),
    )
    curves = []
    for p, (a, b) in enumerate(itertools.pairwise(programs.begins)):
        part = Heated(*(of[..., a:b] for of in found))
        names = {MASS_FRACTION: part.mass, FRACTION_RATE: part.rate}
        if flows[p]:
            T = programs.temperature_K[a:b, None] - lags[p]
            flow = _flow(part, T, rises[p], material, network, values)
            names[HEAT_FLOW] = (flow + _line(experiments[p], T, values)).T
        if burns[p]:
            names[HEAT_RELEASE] = part.release
        curves.append([_curves({n: of[s] for n, of in names.items()}) for s in range(sets)])
    return curves


def _programs(
    requests: Sequence[Request], wanted: Sequence[Collection[str]]
) -> tuple[Programs, list[FloatArray]]:
    """Return the programmes of all requests, and the rise of each, dT/dt [K/s]."""
    temperatures, rises = zip(*(request.programme() for request in requests), strict=True)
    programs = Programs(
        np.concatenate([request.time_s for request in requests]),
        np.concatenate(temperatures),
        np.cumsum([0, *(request.time_s.size for request in requests)]),
        np.array([(HEAT_FLOW in names, HEAT_RELEASE in names) for names in wanted]),
    )
    return programs, list(rises)


def _curves(signals: Mapping[str, FloatArray]) -> Curves:
    finished = all(bool(np.isfinite(curve[-1])) for curve in signals.values())
    return Curves(Status.OK if finished else Status.NON_FINITE, signals)


def _lags(experiments: Sequence[HeatedExperiment], values: Values, sets: int) -> FloatArray:
    """Return by how much each sample is behind its programme [K], shape (experiments, sets)."""
    rows = [
        (0.0 if e.is_isothermal else value_of(e.lag_s, values)) * e.heating_rate_K_min / 60.0
        - value_of(e.temperature_offset_K, values)
        for e in experiments
    ]
    return stack(rows, sets)


def _responses(experiments: Sequence[HeatedExperiment], values: Values, sets: int) -> FloatArray:
    """Return the time constants of the heat release [s], shape (experiments, sets)."""
    return stack([value_of(e.response, values) for e in experiments], sets)


def _flow(
    part: Heated,
    T: FloatArray,
    rise: FloatArray,
    material: words.Material,
    network: Network,
    values: Values,
) -> FloatArray:
    """Return sum_i m_i c_i(T) dT/dt + sum_j dh_j r_j [W/kg], shape (points, sets)."""
    sets = T.shape[1]
    heats = [c.specific_heat_J_kgK for c in material.components.values()]
    capacity = total(
        np.stack(
            [m.T * property_at(c, values, T, sets) for m, c in zip(part.masses, heats, strict=True)]
        )
    )
    taken = [rate.T * dh for rate, dh in zip(part.rates, network.heat, strict=True)]
    return np.asarray(sum(taken, start=capacity * rise[:, None]))


def _line(experiment: HeatedExperiment, T: FloatArray, values: Values) -> FloatArray:
    """Return the baseline [W/kg], shape (points, sets)."""
    line = experiment.line
    level, slope = value_of(line.level_W_kg, values), value_of(line.slope_W_kgK, values)
    return np.asarray(level + slope * (T - value_of(line.reference_temperature_K, values)))
