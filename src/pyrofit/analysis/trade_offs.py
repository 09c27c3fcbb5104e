"""Pairs of strongly correlated estimates."""

from dataclasses import dataclass
from itertools import combinations

from pyrofit.config import Study
from pyrofit.results.identification import Identified

STRONG = 0.7
"""Correlation above which one parameter explains half of the variance of another."""


@dataclass(frozen=True)
class TradeOff:
    """The shift of a best value when another parameter is held off its own.

    Parameters
    ----------
    stage
        'kinetics' or 'imp'.
    name, unit, rise
        The raised parameter, and the rise: its standard deviation.
    partner, partner_unit, shift
        The parameter that compensates for it, and the shift of its best value.
    correlation
        Correlation of the two.
    """

    stage: str
    name: str
    unit: str
    rise: float
    partner: str
    partner_unit: str
    shift: float
    correlation: float


def trade_offs(study: Study, identified: Identified) -> list[TradeOff]:
    """Return the strongly correlated pairs of each stage, the strongest first.

    Of estimates with the covariance C, raising p_i by sd_i moves the best p_j by rho_ij sd_j, all
    other parameters fitted anew. If no pair of a stage is that strong, its strongest is given.
    """
    found = []
    for stage in identified.estimates:
        pairs = sorted(_pairs(study, identified, stage), key=lambda p: -abs(p.correlation))
        found += [p for n, p in enumerate(pairs) if n == 0 or abs(p.correlation) >= STRONG]
    return found


def _pairs(study: Study, identified: Identified, stage: str) -> list[TradeOff]:
    related = identified.correlations[stage]
    sd = identified.estimates[stage]["sd"].to_dict()
    pairs = []
    for name, partner in combinations(related.index, 2):
        one, other = study.parameters[name], study.parameters[partner]
        size = float(related[name][partner])
        shift = size * float(sd[partner]) / other.factor
        rise = float(sd[name]) / one.factor
        pairs.append(TradeOff(stage, name, one.unit, rise, partner, other.unit, shift, size))
    return [p for p in pairs if p.correlation != 0.0]
