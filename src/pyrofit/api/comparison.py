"""Simulated curves beside measured ones, with scores of their agreement."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from pyrofit.api import plots
from pyrofit.api.choices import Key, Signals, complete, si_values, signals_of, with_kinetics_of
from pyrofit.api.measurements import Data, read_measured
from pyrofit.api.simulation import at_times, simulated
from pyrofit.api.studies import Source, read_study
from pyrofit.api.tables import html_page, text_table
from pyrofit.config import Study

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def compare(
    study: Source,
    values: Mapping[str, float],
    *,
    signals: Signals | None = None,
    data: Data | None = None,
    kinetics: str | None = None,
) -> "Comparison":
    """Simulate experiments at the measured times, and score the agreement.

    Use it for experiments that were held out of a fit: ``pf.compare(study, fit.values)``.

    Parameters
    ----------
    study
        A study, its file, or its keys.
    values
        Values of parameters, in the units of the study.
    signals
        Experiments, or signals by experiment; by default all.
    data
        Measured series that replace those of the study, as of `read_data`.
    kinetics
        'described', 'fitted' or a published set of the study, as of `simulate`.

    Raises
    ------
    StudyError
        A name is not known, or a parameter has no value.
    DataError
        A measured series is missing or breaks a rule, or a simulation does not finish.
    """
    study = with_kinetics_of(read_study(study), kinetics)
    keys = signals_of(study, list(study.experiments) if signals is None else signals)
    every = complete(study, si_values(study, values), {name for name, _ in keys})
    return series_compared(study, every, read_measured(study, keys, data))


def series_compared(
    study: Study, values: Mapping[str, float], series: Mapping[Key, pd.DataFrame]
) -> "Comparison":
    """Return measured series beside those of SI values."""
    models = simulated(study, values, at_times(study, series))
    return Comparison(study, dict(series), models)


@dataclass(frozen=True, eq=False)
class Comparison:
    """Measured and simulated series by experiment and signal, SI units."""

    study: Study
    measured: Mapping[Key, pd.DataFrame]
    simulated: Mapping[Key, pd.DataFrame]

    @property
    def scores(self) -> pd.DataFrame:
        """Agreement by experiment and signal.

        Columns: points, rmse and its unit, cv_rmse (RMSE over the mean measured value, of relative
        quantities), r2 = 1 - sum (y - f)^2 / sum (y - mean y)^2.
        """
        return pd.DataFrame([self._score(key) for key in self.measured])

    def _score(self, key: Key) -> dict[str, object]:
        y, f = self.values(key)
        quantity = self.study.experiments[key[0]].quantity(key[1])
        squares, spread = float(np.sum((y - f) ** 2)), float(np.sum((y - y.mean()) ** 2))
        rmse = float(np.sqrt(squares / y.size))
        return {
            "experiment": key[0],
            "signal": key[1],
            "points": y.size,
            "rmse": rmse,
            "unit": quantity.unit,
            "cv_rmse": rmse / abs(float(y.mean())) if quantity.relative else np.nan,
            "r2": 1.0 - squares / spread if spread > 0.0 else np.nan,
        }

    def values(self, key: Key) -> tuple[np.ndarray, np.ndarray]:
        """Return the measured and the simulated values of a signal, shape (points,), SI units."""
        column = self.study.experiments[key[0]].quantity(key[1]).column
        measured_values = self.measured[key][column].to_numpy(float)
        return measured_values, self.simulated[key][column].to_numpy(float)

    @property
    def frame(self) -> pd.DataFrame:
        """All points: experiment, signal, time_s, temperature_K, measured, simulated, unit."""
        parts = []
        for key, frame in self.measured.items():
            y, f = self.values(key)
            columns = {
                "experiment": key[0],
                "signal": key[1],
                "time_s": frame["time_s"],
                "temperature_K": frame.get("temperature_K", np.nan),
                "measured": y,
                "simulated": f,
                "unit": self.study.experiments[key[0]].quantity(key[1]).unit,
            }
            parts.append(pd.DataFrame(columns))
        return pd.concat(parts, ignore_index=True)

    def plot(
        self,
        experiment: str | Key | None = None,
        signal: str | None = None,
        ax: "Axes | None" = None,
    ) -> "Axes":
        """Draw measured and simulated curve on ``ax``, by default on a new one."""
        key = plots.chosen(list(self.measured), experiment, signal)
        ax = plots.axes_of(ax)
        plots.draw_comparison(ax, self.study, key, self.measured[key], self.simulated[key])
        return ax

    def plot_residuals(
        self,
        experiment: str | Key | None = None,
        signal: str | None = None,
        ax: "Axes | None" = None,
    ) -> "Axes":
        """Draw simulated less measured values on ``ax``, by default on a new one."""
        key = plots.chosen(list(self.measured), experiment, signal)
        ax = plots.axes_of(ax)
        plots.draw_residuals(ax, self.study, key, self.measured[key], self.simulated[key])
        return ax

    def plot_all(self) -> "list[Axes]":
        """Draw all signals, a panel for each."""
        axes = plots.new_panels(len(self.measured))
        for ax, key in zip(axes, self.measured, strict=True):
            plots.draw_comparison(ax, self.study, key, self.measured[key], self.simulated[key])
        return axes

    def __str__(self) -> str:
        """Return the scores as text."""
        return text_table(self.scores, "")

    __repr__ = __str__  # a notebook without HTML shows it

    def _repr_html_(self) -> str:
        return html_page(f"measured and simulated: {self.study.name}", [("", self.scores)])
