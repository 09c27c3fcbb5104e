"""The report of a fit, as text and as HTML."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.api.choices import Key
from pyrofit.api.tables import html_page, text_table
from pyrofit.constants import QUANTILE
from pyrofit.show.text import number, several, signed
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Report:
    """The contents of a report, as `Fit` describes them."""

    study: str
    method: str
    table: pd.DataFrame
    fixed: pd.DataFrame
    derived: pd.DataFrame | None
    signals: pd.DataFrame
    correlation: pd.DataFrame | None
    chi2: float
    freedom: float
    cost: float
    verdict: tuple[str, ...] = ()
    weights: Mapping[Key, FloatArray] = field(default_factory=dict)


def text_of_report(fit: Report, above: float) -> str:
    """Return the report as text."""
    lines = [_title(fit), *(f"  {line}" for line in _facts(fit))]
    for heading, table in _tables(fit, above):
        lines += ["", heading, text_table(table)]
    return "\n".join(lines)


def html_of(fit: Report, above: float = 0.3) -> str:
    """Return the report as HTML for a notebook."""
    return html_page(_title(fit), _tables(fit, above), _facts(fit))


def _title(fit: Report) -> str:
    return f"Fit of study '{fit.study}': {fit.method}"


def _facts(fit: Report) -> list[str]:
    points = int(fit.signals["points"].sum())
    counts = (
        f"{several(len(fit.table), 'parameter')}, {several(len(fit.signals), 'signal')}, "
        f"{several(points, 'point')}"
    )
    if not np.isnan(fit.cost):
        return [counts, f"cost {number(fit.cost)}"]
    ratio = fit.chi2 / fit.freedom
    weights = [f"{', '.join(key)}: {_weight(w)}" for key, w in fit.weights.items()]
    return [
        *fit.verdict,
        counts,
        *([f"weights: {'; '.join(weights)}"] if weights else []),
        f"chi-square {number(fit.chi2)}, {number(fit.freedom)} degrees of freedom, ratio "
        f"{number(ratio)}",
    ]


def _weight(weight: FloatArray) -> str:
    low, high = number(float(weight.min())), number(float(weight.max()))
    return low if low == high else f"{low} to {high}"


def _tables(fit: Report, above: float) -> Iterator[tuple[str, pd.DataFrame]]:
    yield "Parameters", _parameters(fit)
    if fit.derived is not None and len(fit.derived):
        yield "Expressions", _derived(fit.derived)
    if len(fit.fixed):
        yield "Fixed", fit.fixed
    none = [] if fit.signals.get("lasting_sd", pd.Series([1.0])).any() else ["lasting_sd"]
    columns = fit.signals.drop(columns=["cv_rmse", "chi2", *none], errors="ignore")
    yield "Signals (rmse and noise in the SI unit)", columns
    if fit.correlation is not None:
        pairs = strong_correlations(fit.correlation, above)
        if len(pairs):
            yield f"Correlations of {above:g} or more", pairs


def _parameters(fit: Report) -> pd.DataFrame:
    """Return the estimates as they are read."""
    rows = []
    for name, row in fit.table.iterrows():
        known = not np.isnan(row["sd"])
        write = partial(to_sd, sd=row["sd"]) if known else number
        at = f"at its {row['at_limit']} limit" if row["at_limit"] else ""
        rows.append(
            {
                "name": name,
                "value": write(row["value"]),
                "sd": write(row["sd"]) if known else "",
                "95 % interval": f"{write(row['low'])} to {write(row['high'])}" if known else "",
                "± by the apparatus": _of_apparatus(row),
                "mostly by": row.get("apparatus_most", ""),
                "unit": row["unit"],
                "limits": f"{number(row['lower'])} to {number(row['upper'])}",
                "remark": row["verdict"] or at,
            }
        )
    frame = pd.DataFrame(rows)
    may_be_empty = ("sd", "95 % interval", "± by the apparatus", "mostly by", "remark")
    empty = [c for c in may_be_empty if not any(frame[c])]
    return frame.drop(columns=empty)


def _of_apparatus(row: "pd.Series[Any]") -> str:
    """Return how far usual errors of the apparatus move an estimate, with 95 %."""
    sd = float(row.get("apparatus_sd", 0.0))
    return number(float(f"{QUANTILE * sd:.2g}")) if sd > 0.0 else ""


def _derived(table: pd.DataFrame) -> pd.DataFrame:
    """Return the expressions as they are read."""
    rows = [
        {
            "name": name,
            "value": to_sd(row["value"], row["sd"]),
            "sd": to_sd(row["sd"], row["sd"]),
            "unit": row["unit"],
            "expression": row["expression"],
        }
        for name, row in table.iterrows()
    ]
    frame = pd.DataFrame(rows)
    return frame if any(frame["sd"]) else frame.drop(columns="sd")


def to_sd(value: float, sd: float) -> str:
    """Write a number to two digits of its standard deviation.

    >>> to_sd(604.99831, 0.03759), to_sd(23512.4, 812.0), to_sd(1.5e-9, 2.2e-11)
    ('604.998', '23512', '1.500e-09')
    """
    size = abs(value)
    if not sd > 0.0 or not np.isfinite(sd) or not (size == 0.0 or 1e-4 <= size < 1e6):
        return number(value)
    return f"{value:.{max(0, 1 - math.floor(math.log10(sd)))}f}"


def strong_correlations(table: pd.DataFrame, above: float) -> pd.DataFrame:
    """Return pairs of parameters whose correlation has some size at least, the largest first.

    >>> both = pd.DataFrame([[1.0, -0.5], [-0.5, 1.0]], index=["k", "cp"], columns=["k", "cp"])
    >>> strong_correlations(both, 0.3).to_numpy().tolist()
    [['k', 'cp', '−0.50']]
    """
    names = list(table.index)
    values = table.to_numpy(float)
    upper = [(i, j) for i in range(len(names)) for j in range(i + 1, len(names))]
    strong = [(i, j) for i, j in upper if abs(values[i, j]) >= above]
    strong.sort(key=lambda pair: -abs(values[pair]))
    rows = [(names[i], names[j], signed(float(values[i, j]))) for i, j in strong]
    return pd.DataFrame(rows, columns=["parameter", "with", "correlation"])
