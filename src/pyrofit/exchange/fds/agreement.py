"""How far FDS is from pyrofit, and how far it may be."""

import math
from typing import NamedTuple

import numpy as np
import pandas as pd

from pyrofit.exchange.fds.predicted import burn_out
from pyrofit.exchange.fds.slab import STRONG_W_M2, Deck
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.outputs import BACK, MASS, MASS_FRACTION, RATE

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
        What of them is compared with the largest that is accepted, and that.
    burnout_s
        Burn-out of FDS minus that of pyrofit [s].
    """

    signal: str
    rms_over_mean: float
    largest: float
    rms: float
    level: tuple[str, float]
    burnout_s: float = math.nan

    @property
    def agrees(self) -> bool:
        """Whether the difference is within its level."""
        name, most = self.level
        return bool(getattr(self, name) <= most)


class Levels(NamedTuple):
    """Largest differences that are accepted; measured ones are a third of them or less."""

    rate: float
    burnout_s: float
    back_K: float
    mass: float
    fraction: float


def levels(flux_W_m2: float, deck: Deck) -> Levels:
    """Return what is accepted of a deck."""
    said = " ".join(remark.what for remark in deck.remarks)
    is_sum = "order" in said
    sharp = is_sum or any(
        "_ID(2,1)" in key for n in deck.namelists for key in n.items if n.group == "MATL"
    )
    strong = flux_W_m2 >= STRONG_W_M2
    rate = 0.01 if sharp else 0.006 if strong else 0.003
    late = 2.0 if sharp else 1.5 if strong else 0.6
    return Levels(
        rate, late, 1.5 if strong else 0.5, 2e-3 if is_sum else 5e-4, 1e-3 if is_sum else 2e-4
    )


def _signal(
    name: str, found: FloatArray, ours: FloatArray, level: tuple[str, float], burnout_s: float
) -> Agreement:
    off = found - ours
    rms = float(np.sqrt(np.mean(off**2)))
    mean = abs(float(np.mean(ours)))
    return Agreement(name, rms / mean, float(np.abs(off).max()), rms, level, burnout_s)


def slab_agreement(fds: pd.DataFrame, ours: pd.DataFrame, accepted: Levels) -> list[Agreement]:
    """Compare a slab: rate, back temperature and mass released.

    Parameters
    ----------
    fds
        Curves of `pyrofit.exchange.fds.read.read_devc`.
    ours
        Curves of `pyrofit.exchange.fds.export.slab_curve`.
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
    found = [
        _signal(
            RATE,
            fds["rate_kg_m2s"].to_numpy(float)[kept],
            rate[kept],
            ("rms_over_mean", accepted.rate),
            late,
        ),
        _signal(
            BACK, fds["back_K"].to_numpy(float)[kept], back[kept], ("rms", accepted.back_K), late
        ),
    ]
    of_mass = Agreement(
        MASS,
        released,
        abs(lost[0] - lost[1]),
        abs(lost[0] - lost[1]),
        ("rms_over_mean", accepted.mass),
        late,
    )
    return [*found, of_mass]


def heated_agreement(fds: pd.DataFrame, ours: pd.DataFrame, accepted: Levels) -> list[Agreement]:
    """Compare the mass fraction of a heated sample at the temperatures of FDS's sample."""
    T = fds["temperature_K"].to_numpy(float)
    kept = float(ours["temperature_K"].iloc[-1]) >= T
    mass = np.interp(T[kept], ours["temperature_K"], ours[MASS_FRACTION])
    found = fds["mass_fraction"].to_numpy(float)[kept]
    return [_signal(MASS_FRACTION, found, mass, ("largest", accepted.fraction), math.nan)]
