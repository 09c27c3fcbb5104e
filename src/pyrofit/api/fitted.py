"""A fit: values, intervals, correlations, scores, curves."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from pyrofit.api import plots
from pyrofit.api.choices import Signals
from pyrofit.api.comparison import Comparison, compare
from pyrofit.api.measurements import Data
from pyrofit.api.report import Report, html_of, text_of
from pyrofit.config import Study
from pyrofit.errors import StudyError
from pyrofit.estimate.identify import Identification
from pyrofit.estimate.likelihood import Likelihood
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
        Estimates by parameter. Columns: value, sd, low and high (95 % interval), unit, lower and
        upper (limits), at_limit, verdict, method ('linear' or 'profile'). All numbers are in
        ``unit``. Without likelihood, sd, low and high are NaN.
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
        Calls of SCE-UA, or the ends of all starts, best first; None with likelihood.
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

    @property
    def reduced_chi2(self) -> float:
        """Chi-square per degree of freedom; above 1 it widens sd and intervals."""
        return self.chi2 / self.freedom

    @property
    def curves(self) -> pd.DataFrame:
        """Measured and fitted values of all points, see `Comparison.frame`."""
        return self.comparison.frame

    def report(self, correlations_above: float = 0.3) -> str:
        """Return the report as text; it lists correlations above a size."""
        return text_of(self._contents(), correlations_above)

    def predict(self, signals: Signals | None = None, data: Data | None = None) -> Comparison:
        """Compare the fit with experiments, by default all; see `pyrofit.compare`."""
        return compare(self.study, self.values, signals=signals, data=data)

    def plot(
        self, experiment: str | None = None, signal: str | None = None, ax: "Axes | None" = None
    ) -> "Axes":
        """Draw a fitted signal with its measurement on ``ax``, by default on a new one."""
        return self.comparison.plot(experiment, signal, ax)

    def plot_residuals(
        self, experiment: str | None = None, signal: str | None = None, ax: "Axes | None" = None
    ) -> "Axes":
        """Draw simulated less measured values on ``ax``, by default on a new one."""
        return self.comparison.plot_residuals(experiment, signal, ax)

    def plot_all(self) -> "list[Axes]":
        """Draw all fitted signals, a panel for each."""
        return self.comparison.plot_all()

    def plot_intervals(self, ax: "Axes | None" = None) -> "Axes":
        """Draw the estimates with 95 % intervals between their limits."""
        ax = plots.new_axes() if ax is None else ax
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
        ax = plots.new_axes() if ax is None else ax
        plots.correlation(ax, self.correlation)
        return ax

    def __str__(self) -> str:
        """Return the report."""
        return self.report()

    def __repr__(self) -> str:
        """Return the report: a notebook without HTML shows it."""
        return self.report()

    def _repr_html_(self) -> str:
        return html_of(self._contents())

    def _contents(self) -> Report:
        return Report(
            self.study.name,
            self.method,
            self.table,
            self.signals,
            self.correlation,
            self.chi2,
            self.freedom,
            self.cost,
        )


def estimates_table(study: Study, likelihood: Likelihood, found: Identification) -> pd.DataFrame:
    """Return estimates and intervals in the units of the study, by parameter."""
    problem = likelihood.problem
    rows = []
    for i, e in enumerate(found.estimates):
        factor = study.parameters[e.name].factor
        lower, span = problem.lower[i] / factor, problem.span[i] / factor
        rows.append(
            {
                "parameter": e.name,
                "value": lower + e.x * span,
                "sd": e.sd * span,
                "low": lower + e.interval.low * span,
                "high": lower + e.interval.high * span,
                "unit": study.parameters[e.name].unit,
                "lower": lower,
                "upper": lower + span,
                "at_limit": e.bound,
                "verdict": e.verdict,
                "method": e.method,
            }
        )
    return pd.DataFrame(rows).set_index("parameter")


def signals_table(
    scored: Comparison, likelihood: Likelihood, found: Identification
) -> pd.DataFrame:
    """Return the agreement by signal, with noise and chi-square."""
    table = scored.scores
    residuals = likelihood.split(likelihood.residuals(found.optimum.x))
    table["noise_sd"] = [float(np.median(noise.total_sd)) for noise in likelihood.noise]
    table["chi2"] = [float(part @ part) for part in residuals]
    table["chi2_per_point"] = [float(part @ part) / part.size for part in residuals]
    return table


def correlation_table(names: Sequence[str], correlation: FloatArray) -> pd.DataFrame:
    """Return a correlation matrix with names."""
    return pd.DataFrame(correlation, index=list(names), columns=list(names))
