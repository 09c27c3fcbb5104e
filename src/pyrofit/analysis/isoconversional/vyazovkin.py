"""Advanced Vyazovkin: from integrals over small steps of conversion.

With the measured temperature T_i(t) of record i, and J_i(E) the integral of exp(-E/(R T_i)) over
the times in which its conversion goes from x - D/2 to x + D/2, E at x minimises

    sum_i sum_(j != i) J_i(E)/J_j(E).

Vyazovkin 2001, doi 10.1002/1096-987X(20010130)22:2<178::AID-JCC5>3.0.CO;2-#. Any heating programme
will do, and E may vary from step to step. Of repeats, ln J is averaged.
"""

from dataclasses import replace

import numpy as np

from pyrofit.analysis.isoconversional.levels import RecordsAtLevels
from pyrofit.analysis.isoconversional.line import Energies, Points, counted, slopes
from pyrofit.constants import GAS_CONSTANT
from pyrofit.numerics import functions
from pyrofit.solver.arrays import FloatArray

LOWEST, HIGHEST = 1e3, 1e6
"""Energies [J/mol] between which the least is sought; one at an end of them is no result."""
_CLEAR = 1.001
_NODES = 33
_SIMPSON = np.array([1.0, *([4.0, 2.0] * 15), 4.0, 1.0]) / 96.0
_SECTIONS = 38
_GOLDEN = 0.6180339887498949


def vyazovkin(runs: RecordsAtLevels, temperature_sd_K: float) -> Energies:
    """Return E [J/mol] of records at levels of conversion.

    Parameters
    ----------
    runs
        The records.
    temperature_sd_K
        Standard deviation of the temperature of a record.
    """
    shape = (len(runs.curves), runs.levels.size)
    x, y, sd = (np.full(shape, np.nan) for _ in range(3))
    value, found = np.full(runs.levels.size, np.nan), []
    for k in range(runs.levels.size):
        steps = {i: step for i in range(shape[0]) if (step := _step(runs, i, k)) is not None}
        groups = [[i for i in group if i in steps] for group in runs.groups]
        groups = [group for group in groups if group]
        energy = _least(steps, groups) if len(groups) >= 2 else LOWEST
        # The search comes to an end where nothing within its limits is the least.
        if LOWEST * _CLEAR < energy < HIGHEST / _CLEAR:
            value[k] = energy
            found.append((k, steps))
    per_kelvin, of_T = counted(value), runs.temperature_sd(temperature_sd_K)
    for k, steps in found:
        for i, step in steps.items():
            x[i, k], log_integral, ends = step.at(value[k])
            # About E, ln J is a line in E: its points are those of y = c - E x.
            y[i, k] = log_integral - value[k] * x[i, k]
            times = np.array([runs.before[i].time_sd[k], runs.after[i].time_sd[k]])
            hot = per_kelvin[k] * x[i, k] / runs.at[i].temperature_K[k] * of_T[i, k]
            sd[i, k] = np.sqrt(float((ends * ends * times * times).sum()) + hot * hot)
    return replace(slopes(Points(x, y, sd), runs.groups), value=value)


class _Step:
    """Times and temperatures of one record in one step of conversion."""

    def __init__(self, time: FloatArray, temperature: FloatArray, reference: float) -> None:
        self.span = float(time[-1] - time[0])
        self.x = 1.0 / (GAS_CONSTANT * temperature)
        self.apart = self.x - 1.0 / (GAS_CONSTANT * reference)

    def log_integral(self, energy: float) -> float:
        """Return ln J, up to a constant that all records share."""
        return float(functions.log(self.span * (_SIMPSON * self._factor(energy)).sum()))

    def at(self, energy: float) -> tuple[float, float, FloatArray]:
        """Return -d ln J/dE, ln J, and the change of ln J with time at both ends."""
        factor = self._factor(energy)
        total = float((_SIMPSON * factor).sum())
        mean = float((_SIMPSON * factor * self.x).sum()) / total
        ends = np.array([factor[0], factor[-1]]) / (total * self.span)
        return mean, float(functions.log(self.span * total)), ends

    def _factor(self, energy: float) -> FloatArray:
        return np.asarray(functions.exp(np.clip(-energy * self.apart, -600.0, 600.0)))


def _step(runs: RecordsAtLevels, i: int, k: int) -> _Step | None:
    """Return a step of a record, none where the record does not cover it."""
    first, last = runs.before[i].time_s[k], runs.after[i].time_s[k]
    if not (last > first and np.isfinite(runs.at[i].time_s[k])):
        return None
    reference = float(np.nanmean([at.temperature_K[k] for at in runs.at]))
    time = np.linspace(first, last, _NODES)
    curve = runs.curves[i]
    return _Step(time, np.interp(time, curve.time_s, curve.temperature_K), reference)


def _least(steps: dict[int, _Step], groups: list[list[int]]) -> float:
    """Return the energy of the least sum, by the golden section."""

    def total(energy: float) -> float:
        means = [float(np.mean([steps[i].log_integral(energy) for i in g])) for g in groups]
        y = np.clip(np.array(means) - float(np.mean(means)), -300.0, 300.0)
        # The terms i = j add a constant.
        return float(functions.exp(y).sum()) * float(functions.exp(-y).sum())

    low, high = LOWEST, HIGHEST
    inner = [high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)]
    found = [total(energy) for energy in inner]
    for _ in range(_SECTIONS):
        if found[0] <= found[1]:
            high, inner[1], found[1] = inner[1], inner[0], found[0]
            inner[0] = high - _GOLDEN * (high - low)
            found[0] = total(inner[0])
        else:
            low, inner[0], found[0] = inner[0], inner[1], found[1]
            inner[1] = low + _GOLDEN * (high - low)
            found[1] = total(inner[1])
    return 0.5 * (low + high)
