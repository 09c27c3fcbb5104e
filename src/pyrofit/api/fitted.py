"""A fit: values, intervals, correlations, scores, curves."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from scipy.stats import norm

from pyrofit.api import plots
from pyrofit.api.arguments import number_of
from pyrofit.api.choices import Key, Signals, used_by
from pyrofit.api.comparison import Comparison, compare
from pyrofit.api.fit_json import as_json, fields_of
from pyrofit.api.measurements import Data
from pyrofit.api.report import Report, html_of, text_of_report
from pyrofit.config import Study
from pyrofit.errors import StudyError
from pyrofit.numerics import functions
from pyrofit.results.goodness import Goodness
from pyrofit.solver.arrays import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class Fit:
    """A fit of a study; print it for a report.

    Parameters
    ----------
    study
        The study.
    method
        Method in words.
    values
        Values of all parameters that the fit uses, estimated or not, in the units of the study.
    table
        Estimates by parameter. Columns: value, sd, apparatus_sd and apparatus_most, low and high
        (95 % interval), unit, lower and upper (limits), at_limit, verdict, method ('linear',
        'profile' or 'misfit'). All numbers are in ``unit``. Without likelihood, sd, low and high
        are NaN.
        Usual errors of the apparatus, apparatus_sd, are part of sd if the model misses the tests;
        apparatus_most is the largest of them in words.
    comparison
        Measured and fitted curves.
    signals
        Agreement by signal: that of ``comparison.scores``, and with a likelihood noise_sd, chi2 and
        chi2_per_point.
    correlation
        Correlation of the estimates; None without likelihood.
    chi2, freedom
        Chi-square and degrees of freedom; NaN without likelihood.
    cost
        Value of the cost function; NaN with likelihood.
    history
        Calls of SCE-UA, or the ends of the followed starts, best first; in the units of the study.
    derived
        Expressions of the study. Columns: value, sd (from the covariance), unit, expression.
    goodness
        Test of the fit: whether the model describes the measured signals, and where it misses them;
        None without likelihood.
    verdict
        The same in sentences.
    weights
        Weights of signals by (experiment, signal), of the shape () or (points,).
    """

    study: Study
    method: str
    values: dict[str, float]
    table: pd.DataFrame
    comparison: Comparison
    signals: pd.DataFrame
    correlation: pd.DataFrame | None = None
    chi2: float = np.nan
    freedom: float = np.nan
    cost: float = np.nan
    history: pd.DataFrame | None = None
    derived: pd.DataFrame | None = None
    goodness: Goodness | None = None
    verdict: tuple[str, ...] = ()
    weights: Mapping[Key, FloatArray] = field(default_factory=dict)

    @property
    def reduced_chi2(self) -> float:
        """Chi-square per degree of freedom; above 1 it widens sd and intervals."""
        return self.chi2 / self.freedom

    @property
    def covariance(self) -> pd.DataFrame | None:
        """Covariance of the estimates in the units of the study; None without likelihood.

        Like sd it is widened by misfit: r_ij sd_i sd_j.
        """
        if self.correlation is None:
            return None
        sd = self.table["sd"].to_numpy(float)
        return self.correlation * np.outer(sd, sd)

    @property
    def aic(self) -> float:
        """Akaike's criterion: chi2 + 2 k for k estimates; NaN without likelihood.

        Each fit has its own noise, so that neither this nor `bic` compares two fits.
        `pyrofit.compare_models` judges several under one noise.
        """
        return self.chi2 + 2.0 * len(self.table)

    @property
    def bic(self) -> float:
        """Criterion of Schwarz: chi2 + k ln n for k estimates and n points."""
        return self.chi2 + len(self.table) * float(functions.log(self.signals["points"].sum()))

    def intervals(self, level: float = 0.95) -> pd.DataFrame:
        """Return low and high of intervals at another level than 95 %, cut at the limits.

        The distances of the 95 % interval from the estimate are multiplied by the ratio of the
        normal quantiles. This is exact for linear intervals, approximate for those of profiles.

        Raises
        ------
        StudyError
            The level is not between 0 and 1.
        """
        if not 0.0 < number_of("level", level) < 1.0:
            raise StudyError(f"level: {level!r} is not between 0 and 1")
        ratio = float(norm.isf(0.5 * (1.0 - level)) / norm.isf(0.025))
        t = self.table
        low, high = (t["value"] + ratio * (t[end] - t["value"]) for end in ("low", "high"))
        return pd.DataFrame({"low": low.clip(t["lower"]), "high": high.clip(upper=t["upper"])})

    @property
    def curves(self) -> pd.DataFrame:
        """Measured and fitted values of all points, see `Comparison.frame`."""
        return self.comparison.frame

    def report(self, correlations_above: float = 0.3) -> str:
        """Return the report as text; it lists correlations above a size."""
        above = number_of("correlations_above", correlations_above)
        return text_of_report(self._contents(), above)

    def summary(self) -> str:
        """Return the verdict in sentences, then each estimate with its interval, as text."""
        lines = list(self.verdict)
        for name, row in self.table.iterrows():
            said = f"{name} = {row['value']:.4g} {row['unit']}"
            if not np.isnan(row["sd"]):
                said += f" ({row['low']:.4g} to {row['high']:.4g}), {row['verdict']}"
            lines.append(said)
        return "\n".join(lines)

    def to_json(self, path: str | os.PathLike[str] | None = None) -> str:
        """Return the fit as JSON with all its curves, and write it to ``path`` where one is given.

        Raises
        ------
        DataError
            The file cannot be written.
        """
        return as_json(self, path)

    @classmethod
    def from_json(cls, source: str | os.PathLike[str]) -> "Fit":
        """Return the fit of a text of `to_json`, or of the file that it wrote, bit for bit.

        Raises
        ------
        DataError
            The file is missing, is no fit, is of another version, or lacks a part.
        StudyError
            Its study breaks a rule of this version.
        """
        return cls(**fields_of(source))

    def predict(self, signals: Signals | None = None, data: Data | None = None) -> Comparison:
        """Compare the fit with experiments, by default all; see `pyrofit.compare`."""
        return compare(self.study, self.values, signals=signals, data=data)

    def plot(
        self,
        experiment: str | Key | None = None,
        signal: str | None = None,
        ax: "Axes | None" = None,
    ) -> "Axes":
        """Draw a fitted signal with its measurement on ``ax``, by default on a new one."""
        return self.comparison.plot(experiment, signal, ax)

    def plot_residuals(
        self,
        experiment: str | Key | None = None,
        signal: str | None = None,
        ax: "Axes | None" = None,
    ) -> "Axes":
        """Draw simulated less measured values on ``ax``, by default on a new one."""
        return self.comparison.plot_residuals(experiment, signal, ax)

    def plot_all(self) -> "list[Axes]":
        """Draw all fitted signals, a panel for each."""
        return self.comparison.plot_all()

    def plot_intervals(self, ax: "Axes | None" = None) -> "Axes":
        """Draw the estimates with 95 % intervals between their limits."""
        ax = plots.axes_of(ax)
        plots.intervals(ax, self.table)
        return ax

    def plot_correlation(self, ax: "Axes | None" = None) -> "Axes":
        """Draw the correlation matrix.

        Raises
        ------
        StudyError
            The fit has none, as it is one of a cost function.
        """
        if self.correlation is None:
            raise StudyError("a fit of a cost has no correlations; leave out `cost`")
        ax = plots.axes_of(ax)
        plots.draw_correlation(ax, self.correlation)
        return ax

    def __str__(self) -> str:
        """Return the report."""
        return self.report()

    __repr__ = __str__  # a notebook without HTML shows it

    def _repr_html_(self) -> str:
        return html_of(self._contents())

    def _fixed(self) -> pd.DataFrame:
        """Return the parameters that the fit uses and does not estimate."""
        used = used_by(self.study, dict.fromkeys(self.signals["experiment"]))
        rows = [
            {"name": name, "value": value, "unit": self.study.parameters[name].unit}
            for name, value in self.values.items()
            if name in used and name not in self.table.index
        ]
        return pd.DataFrame(rows, columns=["name", "value", "unit"])

    def _contents(self) -> Report:
        return Report(
            self.study.name,
            self.method,
            self.table,
            self._fixed(),
            self.derived,
            self.signals,
            self.correlation,
            self.chi2,
            self.freedom,
            self.cost,
            self.verdict,
            self.weights,
        )
