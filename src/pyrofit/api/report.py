"""The report of a fit, as text and as HTML."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from pyrofit.api.tables import html_page, text_table
from pyrofit.errors import StudyError
from pyrofit.show.text import number, several, signed

if TYPE_CHECKING:
    from pyrofit.api.fitted import Fit


def text(fit: "Fit", above: float) -> str:
    """Return the report as text."""
    lines = [_title(fit), *(f"  {line}" for line in _facts(fit))]
    for heading, table in _tables(fit, above):
        lines += ["", heading, text_table(table)]
    return "\n".join(lines)


def html(fit: "Fit", above: float = 0.3) -> str:
    """Return the report as HTML for a notebook."""
    return html_page(_title(fit), _tables(fit, above), _facts(fit))


def known_correlation(fit: "Fit") -> pd.DataFrame:
    """Return the correlations, or refuse where there are none."""
    if fit.correlation is None:
        raise StudyError("a fit of a cost has no correlations; leave out `cost`")
    return fit.correlation


def _title(fit: "Fit") -> str:
    return f"Fit of study '{fit.study.name}': {fit.method}"


def _facts(fit: "Fit") -> list[str]:
    points = int(fit.signals["points"].sum())
    counts = (
        f"{several(len(fit.table), 'parameter')}, {several(len(fit.signals), 'signal')}, "
        f"{several(points, 'point')}"
    )
    if not np.isnan(fit.cost):
        return [counts, f"cost {number(fit.cost)}"]
    return [
        counts,
        f"chi-square {number(fit.chi2)}, {number(fit.freedom)} degrees of freedom, ratio "
        f"{number(fit.reduced_chi2)}",
    ]


def _tables(fit: "Fit", above: float) -> Iterator[tuple[str, pd.DataFrame]]:
    yield "Parameters", _parameters(fit)
    columns = fit.signals.drop(columns=["cv_rmse", "chi2"], errors="ignore")
    yield "Signals (rmse and noise in the SI unit)", columns
    if fit.correlation is not None:
        pairs = correlations(fit.correlation, above)
        if len(pairs):
            yield f"Correlations of {above:g} or more", pairs


def _parameters(fit: "Fit") -> pd.DataFrame:
    """Return the estimates as they are read."""
    rows = []
    for name, row in fit.table.iterrows():
        known = not np.isnan(row["sd"])
        at = f"at its {row['at_limit']} limit" if row["at_limit"] else ""
        rows.append(
            {
                "name": name,
                "value": number(row["value"]),
                "sd": number(row["sd"]),
                "95 % interval": f"{number(row['low'])} to {number(row['high'])}" if known else "",
                "unit": row["unit"],
                "limits": f"{number(row['lower'])} to {number(row['upper'])}",
                "remark": row["verdict"] or at,
            }
        )
    frame = pd.DataFrame(rows)
    empty = [c for c in ("sd", "95 % interval", "remark") if not any(frame[c])]
    return frame.drop(columns=empty)


def correlations(table: pd.DataFrame, above: float) -> pd.DataFrame:
    """Return pairs of parameters whose correlation has some size at least, the largest first.

    >>> both = pd.DataFrame([[1.0, -0.5], [-0.5, 1.0]], index=["k", "cp"], columns=["k", "cp"])
    >>> correlations(both, 0.3).to_numpy().tolist()
    [['k', 'cp', '−0.50']]
    """
    names = list(table.index)
    values = table.to_numpy(float)
    upper = [(i, j) for i in range(len(names)) for j in range(i + 1, len(names))]
    strong = [(i, j) for i, j in upper if abs(values[i, j]) >= above]
    strong.sort(key=lambda pair: -abs(values[pair]))
    rows = [(names[i], names[j], signed(float(values[i, j]))) for i, j in strong]
    return pd.DataFrame(rows, columns=["parameter", "with", "correlation"])
