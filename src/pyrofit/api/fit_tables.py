"""Tables of a fit: estimates, ends of descents, expressions, signals, correlations."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from pyrofit.api.comparison import Comparison
from pyrofit.config import Study
from pyrofit.estimate.bounded_least_squares import Fit as End
from pyrofit.estimate.identify import Identification
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.model.base import value_of
from pyrofit.model.expressions import names_of
from pyrofit.numerics import linear


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
                "apparatus_sd": e.apparatus * span,
                "apparatus_most": e.most,
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


def ends_table(study: Study, likelihood: Likelihood, ends: Sequence[End]) -> pd.DataFrame:
    """Return chi-square and parameters at the ends of descents, in the units of the study."""
    names = likelihood.problem.names
    rows = [
        {"chi2": end.chi2, **dict(zip(names, likelihood.values(end.x).tolist(), strict=True))}
        for end in ends
    ]
    return table_in_units(study, pd.DataFrame(rows))


def table_in_units(study: Study, table: pd.DataFrame) -> pd.DataFrame:
    """Return a table whose columns of parameters have SI units in the units of the study."""
    return table.assign(
        **{n: table[n] / study.parameters[n].factor for n in table.columns if n in study.parameters}
    )


def derived_table(
    study: Study, values: Mapping[str, float], covariance: pd.DataFrame | None
) -> pd.DataFrame:
    """Return the expressions of a study at values in its units.

    The variance is g^T C g, g the derivatives by the estimates of covariance C, from differences.
    """
    rows = []
    for name, parameter in study.parameters.items():
        if parameter.expression is None or not _names(study, name) <= set(values):
            continue
        at = _value(study, name, values)
        variance = np.nan
        if covariance is not None:
            steps = np.sqrt(np.diag(covariance)) * 1e-3
            moved = [
                _value(study, name, {**values, other: values[other] + step}) - at
                for other, step in zip(covariance.index, steps, strict=True)
            ]
            slopes = np.divide(moved, steps, out=np.zeros(len(steps)), where=steps > 0.0)
            variance = linear.dot(linear.product(slopes, covariance.to_numpy()), slopes)
        row = {"parameter": name, "value": at, "sd": float(np.sqrt(variance))}
        rows.append({**row, "unit": parameter.unit, "expression": parameter.expression})
    columns = ["parameter", "value", "sd", "unit", "expression"]
    return pd.DataFrame(rows, columns=columns).set_index("parameter")


def _names(study: Study, name: str) -> set[str]:
    """Return the parameters that a parameter rests on: itself, or those of its expression."""
    text = study.parameters[name].expression
    if text is None:
        return {name}
    return set().union(*(_names(study, other) for other in names_of(text)))


def _value(study: Study, name: str, values: Mapping[str, float]) -> float:
    """Return a parameter in its unit, from those that are no expressions."""
    text = study.parameters[name].expression
    if text is None:
        return values[name]
    return float(value_of(text, {n: _value(study, n, values) for n in names_of(text)}))


def signals_table(
    scored: Comparison, likelihood: Likelihood, found: Identification
) -> pd.DataFrame:
    """Return the agreement by signal, with noise and chi-square."""
    table = scored.scores
    residuals = likelihood.split(likelihood.residuals(found.optimum.x))
    table["noise_sd"] = [float(np.median(noise.sd)) for noise in likelihood.noise]
    table["lasting_sd"] = [float(np.median(noise.lasting_sd)) for noise in likelihood.noise]
    table["chi2"] = [linear.dot(part, part) for part in residuals]
    table["chi2_per_point"] = [linear.dot(part, part) / part.size for part in residuals]
    return table
