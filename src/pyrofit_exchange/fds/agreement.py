"""How far FDS is from pyrofit, and how far it may be."""

import math
from typing import NamedTuple

import numpy as np
import pandas as pd

from pyrofit.cost.distances import root_mean_square
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.outputs import BACK, MASS, MASS_FRACTION, RATE
from pyrofit_exchange.fds.materials import SUM
from pyrofit_exchange.fds.predicted import burn_out
from pyrofit_exchange.fds.slab import WEAK_STEP_S, Deck

BEFORE_S = 10.0
"""Rates and temperatures are compared until so long before burn-out: then the foil is left."""


class Agreement(NamedTuple):
    """How far one signal of FDS is from pyrofit's.

    Parameters
    ----------
    signal
        The signal.
    rms_over_mean
        Root mean square of the difference over the mean of pyrofit's curve.
    largest, rms
        Largest difference and its root mean square, SI units.
    level
        Name of the difference that is judged, and its largest accepted value.
    burnout_s
        Burn-out of FDS minus that of pyrofit [s].
    latest_s
        Largest difference of burn-out that is accepted [s].
    """

    signal: str
    rms_over_mean: float
    largest: float
    rms: float
    level: tuple[str, float]
    burnout_s: float = math.nan
    latest_s: float = math.inf

    @property
    def verdict(self) -> str:
        """Agrees or differs; none where a term is approximate or left out."""
        name, most = self.level
        if math.isinf(most):
            return "approximate terms"
        on_time = math.isnan(self.burnout_s) or abs(self.burnout_s) <= self.latest_s
        return "agrees" if getattr(self, name) <= most and on_time else "differs"


class Levels(NamedTuple):
    """Largest differences that are accepted."""

    rate: float
    burnout_s: float
    back_K: float
    mass: float
    fraction: float


def levels(deck: Deck) -> Levels:
    """Return the accepted differences; infinite where a term is approximate or left out."""
    sums = [r for r in deck.remarks if SUM in r.how]
    if any(r.kind != "when read" and r not in sums for r in deck.remarks):
        return Levels(math.inf, math.inf, math.inf, math.inf, math.inf)
    reacting = [n.items for n in deck.namelists if n.group == "MATL"]
    sharp = bool(sums) or any("MATL_ID(2,1)" in items for items in reacting)
    strong = 0.0 < deck.step_s < WEAK_STEP_S
    return Levels(
        rate=0.01 if sharp else 0.006 if strong else 0.003,
        burnout_s=2.0 if sharp else 1.5 if strong else 0.6,
        back_K=1.5 if strong else 0.5,
        mass=2e-3 if sums else 5e-4,
        fraction=1e-3 if sums else 2e-4,
    )


def _signal(name: str, found: FloatArray, ours: FloatArray, level: tuple[str, float]) -> Agreement:
    off = found - ours
    rms = root_mean_square(off)
    mean = abs(float(np.mean(ours)))
    return Agreement(name, rms / mean, float(np.abs(off).max()), rms, level)


def slab_agreement(fds: pd.DataFrame, ours: pd.DataFrame, accepted: Levels) -> list[Agreement]:
    """Compare a slab: rate, back temperature and mass released.

    Parameters
    ----------
    fds
        Curves of `pyrofit_exchange.fds.read.read_devc`.
    ours
        Curves of `pyrofit_exchange.fds.export.slab_curve`.
    accepted
        Largest differences.
    """
    time = fds["time_s"].to_numpy(float)
    curves = {
        name: np.interp(time, ours["time_s"], ours[name])
        for name in (f"{RATE}_kg_m2s", f"{BACK}_K", f"{MASS}_kg_m2")
    }
    rate, back, mass = curves.values()
    ends = [burn_out(time, r) for r in (fds["rate_kg_m2s"].to_numpy(float), rate)]
    late = ends[0] - ends[1]
    until = min((end for end in ends if math.isfinite(end)), default=math.inf) - BEFORE_S
    last = min(float(time[-1]), float(ours["time_s"].iloc[-1]))
    kept = (time < until) & (time <= last) & (time > 1.0)
    lost = [float(m[0] - m[time <= last][-1]) for m in (fds["mass_kg_m2"].to_numpy(float), mass)]
    released = abs(lost[0] / lost[1] - 1.0) if lost[1] else math.nan
    pairs = {
        RATE: (fds["rate_kg_m2s"], rate, ("rms_over_mean", accepted.rate)),
        BACK: (fds["back_K"], back, ("rms", accepted.back_K)),
    }
    found = [
        _signal(name, theirs.to_numpy(float)[kept], own[kept], level)
        for name, (theirs, own, level) in pairs.items()
    ]
    off = abs(lost[0] - lost[1])
    found.append(Agreement(MASS, released, off, off, ("rms_over_mean", accepted.mass)))
    first, *rest = found
    return [
        first._replace(burnout_s=late, latest_s=accepted.burnout_s),
        *(of._replace(burnout_s=late) for of in rest),
    ]


def heated_agreement(fds: pd.DataFrame, ours: pd.DataFrame, accepted: Levels) -> list[Agreement]:
    """Compare the mass fraction of a heated sample at the temperatures of FDS's sample."""
    T = fds["temperature_K"].to_numpy(float)
    kept = float(ours["temperature_K"].iloc[-1]) >= T
    mass = np.interp(T[kept], ours["temperature_K"], ours[MASS_FRACTION])
    found = fds[MASS_FRACTION].to_numpy(float)[kept]
    return [_signal(MASS_FRACTION, found, mass, ("largest", accepted.fraction))]
