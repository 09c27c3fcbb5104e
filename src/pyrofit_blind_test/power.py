"""The power of the diagnosis: from which detectability an effect is named."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from pyrofit.numerics import functions
from pyrofit.solver.arrays import FloatArray
from pyrofit_blind_test.table import one_name

FEWEST = 4
"""Twins from which an effect has a power of its own."""
MIDDLES = functions.geometric(0.5, 500.0, 181)
"""Detectabilities at which half may be named [standard deviations]."""
SLOPES = functions.geometric(0.5, 16.0, 61)
ODDS = {"half": 1.0, "nine_tenths": 9.0}
"""Odds of the named shares whose detectability is stated."""
TAILS = (0.5, 0.025, 0.975)


def power_of_diagnosis(twins: pd.DataFrame) -> pd.DataFrame:
    """Return the detectability from which half and nine tenths of the effects are rightly named.

    One row for all twins with one effect, and one for each effect with at least 4 of them.
    """
    effects = twins[twins["kind"] == "effect"]
    return pd.DataFrame([{"of": of, **_row(part)} for of, part in _parts(effects)])


def _parts(effects: pd.DataFrame) -> Iterator[tuple[str, pd.DataFrame]]:
    if len(effects):
        yield "all", effects
    names = effects["hidden"].map(one_name) if len(effects) else effects["hidden"]
    for name, part in effects.groupby(names):
        if len(part) >= FEWEST:
            yield str(name), part


def _row(part: pd.DataFrame) -> dict[str, float]:
    found = thresholds(part["detectability"].to_numpy(float), part["right"].to_numpy(bool))
    row: dict[str, float] = {"twins": len(part), "named": int(part["right"].sum())}
    for share, values in found.items():
        row |= dict(zip((share, f"{share}_low", f"{share}_high"), values, strict=True))
    return row


def thresholds(detectability: FloatArray, named: FloatArray) -> dict[str, tuple[float, ...]]:
    """Return median and 95 % interval of the detectabilities at which shares are named.

    p(d) = 1 / (1 + (m / d)^s). m and s have a prior that is flat in their logarithms: 0.5 to 500
    standard deviations, and 0.5 to 16. The nine tenths are at m 9^(1/s). The posterior also exists
    where all are named or none; the interval then reaches to a limit of the prior.

    Parameters
    ----------
    detectability
        d [standard deviations], shape (twins,).
    named
        Whether each was rightly named, shape (twins,).

    Examples
    --------
    >>> d = np.repeat([1.0, 3.0, 9.0, 27.0], 50)
    >>> share = np.repeat([0.0, 0.0, 1.0, 1.0], 50)
    >>> middle, low, high = thresholds(d, share)["half"]
    >>> bool(3.0 < low < middle < high < 9.0)
    True
    """
    distance = functions.log(np.maximum(detectability, 1e-3))[:, None] - functions.log(MIDDLES)
    sign = np.where(named, 1.0, -1.0)[:, None]
    score = np.stack(
        [-functions.log_one_plus_exp(-sign * s * distance).sum(axis=0) for s in SLOPES]
    )
    weight = functions.exp(score - score.max())
    found = {}
    for share, odds in ODDS.items():
        values = MIDDLES * functions.power(odds, 1.0 / SLOPES[:, None])
        found[share] = _quantiles(values.ravel(), weight.ravel())
    return found


def _quantiles(values: FloatArray, weight: FloatArray) -> tuple[float, ...]:
    order = np.argsort(values, kind="stable")
    mass = np.cumsum(weight[order])
    at = np.searchsorted(mass, np.array(TAILS) * mass[-1])
    return tuple(float(value) for value in values[order][at])
