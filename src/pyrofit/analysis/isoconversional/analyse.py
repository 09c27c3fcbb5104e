"""The analysis of a material's records: three methods, beside the same for a model's curves."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from pyrofit.analysis.isoconversional.curve import Curve
from pyrofit.analysis.isoconversional.levels import LEVELS, RecordsAtLevels, runs_of
from pyrofit.analysis.isoconversional.line import Energies, Points, counted, slopes
from pyrofit.analysis.isoconversional.vyazovkin import vyazovkin
from pyrofit.constants import GAS_CONSTANT
from pyrofit.numerics import functions
from pyrofit.solver.arrays import FloatArray


def kas(runs: RecordsAtLevels, temperature_sd_K: float) -> Energies:
    """Return E [J/mol] of the records of a constant heating rate, at levels of conversion.

    Parameters
    ----------
    runs
        The records; those without a constant rate do not count.
    temperature_sd_K
        Standard deviation of the temperature of a record.
    """
    constant = np.array([curve.rate_K_min is not None for curve in runs.curves])
    rate = np.array([_measured_rate(runs, i) for i in range(len(runs.curves))])
    temperature = np.where(constant[:, None], runs.stacked("temperature_K"), np.nan)
    x = 1.0 / (GAS_CONSTANT * temperature)
    y = functions.log(rate[:, None] / (temperature * temperature))
    first = slopes(Points(x, y, np.zeros(x.shape)), runs.groups)
    shift = rate[:, None] * runs.stacked("time_sd")
    per_kelvin = counted(first.value) * x / temperature + 2.0 / temperature
    sd = per_kelvin * np.sqrt(shift * shift + runs.temperature_sd(temperature_sd_K) ** 2)
    return slopes(Points(x, y, sd), runs.groups)


def _measured_rate(runs: RecordsAtLevels, i: int) -> float:
    """Return the mean heating rate [K/s] of a record between its first and last level."""
    time, temperature = runs.at[i].time_s, runs.at[i].temperature_K
    known = np.flatnonzero(np.isfinite(time))
    if known.size < 2:
        return float("nan")
    first, last = known[0], known[-1]
    rise = float(temperature[last] - temperature[first])
    return rise / float(time[last] - time[first]) if rise > 0.0 else float("nan")


def friedman(runs: RecordsAtLevels, temperature_sd_K: float) -> Energies:
    """Return E [J/mol] of records at levels of conversion.

    Parameters
    ----------
    runs
        The records.
    temperature_sd_K
        Standard deviation of the temperature of a record.
    """
    temperature, rate = runs.stacked("temperature_K"), runs.stacked("rate")
    x = 1.0 / (GAS_CONSTANT * temperature)
    y = functions.log(rate)
    first = slopes(Points(x, y, np.zeros(x.shape)), runs.groups)
    # A shift of the time at which a level is reached moves the temperature there as well.
    shift = runs.stacked("heating_K_s") * runs.stacked("time_sd")
    per_kelvin = counted(first.value) * x / temperature
    of_rate = runs.stacked("log_rate_sd")
    square = of_rate * of_rate
    square = square + per_kelvin * per_kelvin * (
        shift * shift + runs.temperature_sd(temperature_sd_K) ** 2
    )
    return slopes(Points(x, y, np.sqrt(square)), runs.groups)


METHODS: dict[str, Callable[[RecordsAtLevels, float], Energies]] = {
    "friedman": friedman,
    "kas": kas,
    "vyazovkin": vyazovkin,
}
TEMPERATURE_SD_K = 0.5
"""Standard deviation of the temperature of a record where no repeats tell it."""
_WORTH = 4
"""Degrees of freedom that this standard deviation counts as, beside those of repeats."""


@dataclass(frozen=True, eq=False)
class Analysis:
    """Activation energies over conversion.

    Parameters
    ----------
    runs
        The records at the levels of conversion.
    energies
        By method: 'friedman', 'kas', 'vyazovkin'.
    model
        The same of the model's curves at the records' times and temperatures; empty without one.
    temperature_sd_K
        Standard deviation of the temperature of a record that the errors contain.
    """

    runs: RecordsAtLevels
    energies: dict[str, Energies]
    model: dict[str, Energies]
    temperature_sd_K: float

    @property
    def levels(self) -> FloatArray:
        """Levels of conversion."""
        return self.runs.levels

    @property
    def table(self) -> pd.DataFrame:
        """E over conversion [kJ/mol], its error (half of a 95 % interval), and that of the model.

        Columns ``conversion``, ``temperature_K`` (mean over the records); ``friedman_kJ_mol``,
        ``friedman_error_kJ_mol`` and so on for ``kas`` and ``vyazovkin``; with a model
        ``model_friedman_kJ_mol`` and so on. nan where fewer than two programmes tell E.
        """
        temperature = self.runs.stacked("temperature_K")
        known = np.isfinite(temperature)
        total = np.where(known, temperature, 0.0).sum(axis=0)
        mean = np.where(known.any(axis=0), total / np.maximum(known.sum(axis=0), 1), np.nan)
        columns: dict[str, FloatArray] = {
            "conversion": np.round(self.levels, 6),
            "temperature_K": mean,
        }
        for method, found in self.energies.items():
            columns[f"{method}_kJ_mol"] = found.value / 1e3
            columns[f"{method}_error_kJ_mol"] = found.error / 1e3
        for method, found in self.model.items():
            columns[f"model_{method}_kJ_mol"] = found.value / 1e3
        return pd.DataFrame(columns)


def analyse(
    curves: Sequence[Curve],
    model: Sequence[Curve] = (),
    temperature_sd_K: float | None = None,
) -> Analysis:
    """Return the activation energies of records over conversion.

    Parameters
    ----------
    curves
        The records, of two conditions at least.
    model
        Curves of a model at their times and temperatures.
    temperature_sd_K
        Standard deviation of the temperature of a record about that of the others; default: by
        repeats, and 0.5 K where there are none.
    """
    runs = runs_of(curves)
    sd = _temperature_sd(runs) if temperature_sd_K is None else temperature_sd_K
    of_model: dict[str, Energies] = {}
    if model:
        simulated = runs_of(model, runs.reach)
        of_model = {name: method(simulated, 0.0) for name, method in METHODS.items()}
    found = {name: method(runs, sd) for name, method in METHODS.items()}
    return Analysis(runs, found, of_model, sd)


def no_table() -> pd.DataFrame:
    """Return the table of an analysis that finds nothing."""
    columns = [f"{m}{end}_kJ_mol" for m in METHODS for end in ("", "_error")]
    nothing = dict.fromkeys(["temperature_K", *columns], np.nan)
    return pd.DataFrame({"conversion": np.round(LEVELS, 6), **nothing})


def _temperature_sd(runs: RecordsAtLevels) -> float:
    """Return the scatter of the temperature among repeats, joined with the usual one."""
    # ASSUME: repeats of one laboratory differ by 0.1 to 1 K, as those of the MaCFP data base.
    square, freedom = _WORTH * TEMPERATURE_SD_K * TEMPERATURE_SD_K, _WORTH
    temperature = runs.stacked("temperature_K")
    for group in runs.groups:
        if len(group) < 2:
            continue
        of_group = temperature[group][:, np.isfinite(temperature[group]).all(axis=0)]
        if runs.curves[group[0]].rate_K_min is not None and of_group.size:
            apart = of_group - of_group.mean(axis=0)
            square += float((apart * apart).sum()) / of_group.shape[1]
            freedom += len(group) - 1
    return float(np.sqrt(square / freedom))
