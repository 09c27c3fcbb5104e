"""Water that a slab gives off, as its temperatures show it, where the model holds none."""

import math
from collections.abc import Iterator, Mapping

import numpy as np

from pyrofit.config import Study
from pyrofit.constants import GAS_CONSTANT
from pyrofit.estimate.targets import Measurements
from pyrofit.model.base import value_of
from pyrofit.model.material import Reaction
from pyrofit.model.slab import SlabExperiment
from pyrofit.solver.arrays import FloatArray

LEVELS_K = np.arange(310.0, 491.0, 10.0)
"""Temperatures between which a rise is timed [K]."""
BOILS_K = 355.0, 415.0
"""Where water holds a temperature up [K]: vapour inside a sample has some excess pressure."""
SLOWED = 0.6
"""Share of the rise before, and of that after, below which a rise counts as held up."""
DRIES_K = 420.0
"""Temperature [K] below which the rate constant of a drying may reach 0.001 1/s."""
RATE_1_S = 1e-3
CHARS = 0.1
"""Yield of a solid above which a material chars. Others hold little water."""


def held_up_of(study: Study, measurements: Measurements) -> Iterator[tuple[str, str, float]]:
    """Yield test, signal and temperature [K] of each rise that is held up in a slab without water.

    Of a test the first such record counts. Only materials that char are looked at.

    Parameters
    ----------
    study, measurements
        The study, and its measured series by (experiment, signal), SI units.
    """
    if not chars(study):
        return
    seen = set()
    for (name, signal), frame in measurements.items():
        slab = study.experiments[name]
        test = slab.repeat.test if slab.repeat else name
        quantity = slab.quantity(signal)
        if not (isinstance(slab, SlabExperiment) and quantity.is_temperature) or test in seen:
            continue
        at = held_up(*(frame[column].to_numpy(float) for column in ("time_s", quantity.column)))
        if at is not None and not holds_water(study, slab):
            seen.add(test)
            yield test, signal, at


def chars(study: Study) -> bool:
    """Tell whether a reaction may leave more than a tenth of its reactant as a solid."""
    yields = (y for r in study.material.reactions.values() for y in r.products.values())
    return any(_known(y, _ends(study)[1], 1.0) > CHARS for y in yields)


def holds_water(study: Study, slab: SlabExperiment) -> bool:
    """Tell whether a layer of a slab may hold a substance that leaves as a gas below `DRIES_K`."""
    least, most = _ends(study)
    reactions = study.material.reactions.values()
    leaves = {reaction.reactant for reaction in reactions if _is_drying(reaction, least)}
    compositions = (layer.composed(study.material.composition) for layer in slab.sample.layers)
    shares = (share for of in compositions for name, share in of.items() if name in leaves)
    return any(_known(share, most, 1.0) > 0.0 for share in shares)


def _ends(study: Study) -> tuple[dict[str, float], dict[str, float]]:
    """Return the least and the largest values that parameters may have, SI units."""
    given = study.fixed_values()
    free = {n: p for n, p in study.parameters.items() if n not in given and p.lower is not None}
    ends = {name: p.bounds_si for name, p in free.items()}
    return {n: e[0] for n, e in ends.items()} | given, {n: e[1] for n, e in ends.items()} | given


def _is_drying(reaction: Reaction, values: Mapping[str, float]) -> bool:
    if reaction.products:
        return False
    if reaction.reference_temperature_K is not None:
        return _known(reaction.reference_temperature_K, values, math.inf) < DRIES_K
    E, A = _known(reaction.E_J_mol, values, math.inf), _known(reaction.A_1_s or 0.0, values, 0.0)
    return A > RATE_1_S and E / (GAS_CONSTANT * math.log(A / RATE_1_S)) < DRIES_K


def _known(number: float | str, values: Mapping[str, float], else_: float) -> float:
    """Return a number, or that of its parameters as far as they are given."""
    try:
        return float(value_of(number, values))
    except (KeyError, ValueError):
        return else_


def held_up(time: FloatArray, temperature: FloatArray) -> float | None:
    """Return the temperature [K] near 100 degrees C at which a rise is held up; None where none is.

    The rise between levels of 10 K is slowest there, below 0.6 of the fastest one before and of the
    fastest one after it.

    Parameters
    ----------
    time, temperature
        A record [s, K], shape (n,) each.

    Examples
    --------
    >>> t = np.linspace(0.0, 1000.0, 1001)
    >>> held_up(t, np.interp(t, [0.0, 200.0, 500.0, 1000.0], [300.0, 370.0, 380.0, 600.0]))
    375.0
    >>> held_up(t, 300.0 + 0.3 * t) is None
    True
    """
    rising = np.maximum.accumulate(temperature)
    first = np.flatnonzero(np.diff(rising, prepend=-np.inf) > 0.0)
    levels = LEVELS_K[(rising[0] < LEVELS_K) & (rising[-1] > LEVELS_K)]
    took = np.diff(np.interp(levels, rising[first], time[first]))
    speed = np.diff(levels) / np.maximum(took, 1e-9)
    middle = 0.5 * (levels[1:] + levels[:-1])
    near = np.flatnonzero((middle > BOILS_K[0]) & (middle < BOILS_K[1]))
    if not near.size:
        return None
    at = near[np.argmin(speed[near])]
    before, after = speed[:at], speed[at + 1 :]
    if not (before.size and after.size):
        return None
    return float(middle[at]) if speed[at] < SLOWED * min(before.max(), after.max()) else None
