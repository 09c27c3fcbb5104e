"""Reactions that are fast at room temperature already."""

import itertools
import math
from collections.abc import Iterator

from pyrofit.config.check.expressions import ends_of
from pyrofit.config.keys.study import Study
from pyrofit.constants import GAS_CONSTANT
from pyrofit.model.material import Reaction

ROOM_K = 293.15
FAST_1_S = 1e-4
"""Rate constant at room temperature from which on a reaction is told."""
_REACTS_1_S = 1e-3
_MOST = 650.0


def reacts_cold(A_1_s: float, E_J_mol: float, order: float = 1.0) -> str:
    """Say how fast a reaction is at room temperature; nothing where it is slow.

    k = A exp(-E/(R T)); half of the reactant is gone after ln 2 / k at order 1, after
    (2^(n-1) - 1)/((n-1) k) at order n.

    Parameters
    ----------
    A_1_s : float
        Pre-exponential factor of r = A exp(-E/(R T)) m0 (m/m0)^n [1/s].
    E_J_mol : float
        Activation energy [J/mol].
    order : float
        Reaction order n [-].

    Examples
    --------
    >>> reacts_cold(5.28e26, 1.36e5, 3.31)
    'it reacts at room temperature: half of it is gone in 0.0055 s at 293 K, and k = 0.001 1/s at 239 K. Check A and E, and their units'
    >>> reacts_cold(1e13, 1.8e5)
    ''
    """  # noqa: E501
    if not 0.0 < A_1_s < math.inf:
        return ""
    logarithm = math.log(A_1_s) - E_J_mol / (GAS_CONSTANT * ROOM_K)
    if logarithm < math.log(FAST_1_S):
        return ""
    n = order - 1.0
    half = math.log(2.0) if abs(n) < 1e-6 else math.expm1(n * math.log(2.0)) / n
    cold = ""
    if A_1_s > _REACTS_1_S and E_J_mol > 0.0:
        T = E_J_mol / (GAS_CONSTANT * math.log(A_1_s / _REACTS_1_S))
        cold = f", and k = 0.001 1/s at {T:.0f} K"
    return (
        f"it reacts at room temperature: half of it is gone in {half * math.exp(-logarithm):.2g} s "
        f"at {ROOM_K:.0f} K{cold}. Check A and E, and their units"
    )


def cold_reactions(study: Study) -> Iterator[str]:
    """Yield a sentence for each reaction that is fast at room temperature for all its values."""
    for name, reaction in study.material.reactions.items():
        said = [reacts_cold(*rate) for rate in _rates(study, reaction)]
        if said and all(said):
            yield f"material.reactions.{name}: {min(said, key=len)}"


def _rates(study: Study, reaction: Reaction) -> Iterator[tuple[float, float, float]]:
    """Yield A [1/s], E [J/mol] and order of a reaction at the ends of its parameters."""
    energies, orders = _values(study, reaction.E_J_mol), _values(study, reaction.order)
    if reaction.A_1_s is not None:
        yield from itertools.product(_values(study, reaction.A_1_s), energies, orders)
        return
    assert reaction.reference_temperature_K is not None
    assert reaction.reference_rate_1_s is not None
    temperatures = _values(study, reaction.reference_temperature_K)
    rates = _values(study, reaction.reference_rate_1_s)
    for T, rate, E, order in itertools.product(temperatures, rates, energies, orders):
        exponent = E / (GAS_CONSTANT * T)
        yield rate * math.exp(exponent) if exponent < _MOST else math.inf, E, order


def _values(study: Study, number: float | str) -> list[float]:
    """Return the value of a number, or that of its parameter, or both limits."""
    if not isinstance(number, str):
        return [number]
    if not number.isidentifier():
        return list(ends_of(study, number))
    one = study.parameters[number]
    given = [one.value] if one.value is not None else [one.lower, one.upper]
    return [value * one.factor for value in given if value is not None]
