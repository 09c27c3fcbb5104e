"""The search: schemes are extended feature by feature, the best of each round further."""

from collections.abc import Mapping

import numpy as np

from pyrofit.logs import Tell
from pyrofit.scheme.arrangements.base import PREFIX
from pyrofit.scheme.fit import FittedScheme, SchemeSetting, fit_posed
from pyrofit.scheme.posed import Posed, may_lag, own, pose_scheme
from pyrofit.scheme.schemes import PARALLEL, Scheme
from pyrofit.seeds import seed_for

Values = Mapping[str, float]

NEW: dict[str, tuple[float, ...]] = {
    "n": (1.0, 1.8),
    "w": (0.03, 0.2),
    "y": (0.1, 0.6),
    "lag": (3.0,),
    "volatile_share": (0.03,),
    "volatile_temperature_K": (460.0,),
    "volatile_E_J_mol": (1.1e5,),
}
"""Values from which a parameter starts that a scheme has and the extended one has not, SI units."""
SHIFTS_K = (-60.0, 0.0, 25.0)
"""Temperature of a further reaction at first, from that of the first one."""


def search_schemes(setting: SchemeSetting, tell: Tell) -> list[FittedScheme]:
    """Fit schemes from one reaction of first order upwards; return them, least BIC first.

    Each round extends the best schemes so far by one feature: a reaction, an order, an early
    volatile, a lag. The search ends where a round lowers the least BIC no more.
    """
    settings = setting.settings
    lag = may_lag(setting.study, setting.records)
    fitted: dict[Scheme, FittedScheme] = {}
    ahead = {Scheme()}
    least = np.inf
    while ahead:
        for scheme in sorted(ahead):
            parents = [
                f for s, f in fitted.items() if scheme in s.extensions(settings.most_reactions, lag)
            ]
            fitted[scheme] = found = _fit(setting, scheme, parents)
            tell(f"{scheme.words}: BIC {found.bic:.1f}, {found.size:g} is left over")
        now = min(f.bic for f in fitted.values())
        if least - now <= settings.worth_bic:
            break
        least = now
        near = [s for s, f in fitted.items() if f.bic <= now + settings.branch_bic]
        best = sorted(near, key=lambda s: fitted[s].bic)[: settings.branches]
        new = {x for s in best for x in s.extensions(settings.most_reactions, lag)}
        ahead = new - set(fitted)
    return sorted(fitted.values(), key=lambda f: f.bic)


def _fit(setting: SchemeSetting, scheme: Scheme, parents: list[FittedScheme]) -> FittedScheme:
    """Fit a scheme from the two best fits that it extends, and from random starts."""
    parents = sorted(parents, key=lambda f: f.bic)[:2]
    starts = [start for parent in parents for start in starts_from(parent, scheme)]
    posed = pose_scheme(setting.study, scheme, setting.records, setting.settings)
    size = parents[0].size if parents else None
    rng = _rng(setting, posed)
    return fit_posed(setting, posed, setting.calibrated, starts, rng, size)


def fit_own(setting: SchemeSetting) -> FittedScheme:
    """Fit the scheme that the study describes."""
    posed = own(setting.study, setting.records)
    return fit_posed(setting, posed, setting.calibrated, [], _rng(setting, posed))


def _rng(setting: SchemeSetting, posed: Posed) -> np.random.Generator:
    return np.random.default_rng(seed_for(setting.study.seed, "scheme", posed.name))


def starts_from(parent: FittedScheme, scheme: Scheme) -> list[Values]:
    """Return starts of a scheme from the fit of one that it extends."""
    assert parent.posed.scheme is not None
    grown = scheme.reactions > parent.posed.scheme.reactions
    values = parent.values
    first = values[f"{PREFIX}T_1"]
    energy = values[f"{PREFIX}E_1"]
    starts: list[Values] = []
    for shift in SHIFTS_K if grown else SHIFTS_K[:1]:
        for k in range(2):
            new: dict[str, float] = {}
            for i in range(1, scheme.reactions + 1):
                new |= {f"T_{i}": first + shift, f"E_{i}": energy}
                new |= {key: NEW[key[0]][k] for key in (f"n_{i}", f"w_{i}", f"y_{i}")}
            new |= {key: given[k % len(given)] for key, given in NEW.items() if len(key) > 1}
            started = {PREFIX + key: value for key, value in new.items()} | values
            starts.append(largest_first(started) if scheme.arrangement == PARALLEL else started)
    return starts


def largest_first(values: Values) -> dict[str, float]:
    """Return values with parallel components numbered by their shares, the largest first.

    >>> found = largest_first({"scheme_w_2": 0.7, "scheme_T_1": 500.0, "scheme_T_2": 600.0})
    >>> found["scheme_T_1"], round(found["scheme_w_2"], 9)
    (600.0, 0.3)
    """
    shares = {1: 1.0}
    for i in range(2, 10):
        if f"{PREFIX}w_{i}" in values and f"{PREFIX}T_{i}" in values:
            shares[i] = values[f"{PREFIX}w_{i}"]
    shares[1] -= sum(shares.values()) - 1.0
    renamed = dict(values)
    for new, old in enumerate(sorted(shares, key=lambda i: -shares[i]), 1):
        for key in ("T", "E", "n"):
            if f"{PREFIX}{key}_{old}" in values:
                renamed[f"{PREFIX}{key}_{new}"] = values[f"{PREFIX}{key}_{old}"]
        if new > 1:
            renamed[f"{PREFIX}w_{new}"] = shares[old]
    return renamed
