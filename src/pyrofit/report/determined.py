"""What the data determine, in sentences whose every number comes from the tables."""

import re
from collections.abc import Mapping
from typing import Any

import pandas as pd

from pyrofit.report.words import listed, span

Frames = dict[str, pd.DataFrame]

AT_BOUND = "at a bound"
_FITS = 1.2
"""Chi-square per point up to which the model is said to fit within the noise."""


def verdicts(tables: Frames) -> str:
    """Say which parameters the data determine, which weakly, which not."""
    parts = [
        f"of the {fit} {_sorted(rows)}"
        for fit, rows in tables["determined"].groupby("fit", sort=False)
    ]
    return f"By the data (width of the 95 % interval, % of the limits): {'; '.join(parts)}."


def _sorted(table: pd.DataFrame) -> str:
    """List parameters by verdict."""
    return ", ".join(f"{verdict} {listed(names)}" for verdict, names in by_verdict(table).items())


def by_verdict(table: pd.DataFrame) -> dict[str, list[str]]:
    """Return the parameters, each with the width of its interval, by verdict, the best first."""
    words = table["verdict"].str.partition(",")[0].str.replace(r"^at its .*", AT_BOUND, regex=True)
    verdicts = ("determined", "weakly determined", AT_BOUND, "undetermined")
    found = {v: [_named(row) for row in table[words == v].to_dict("records")] for v in verdicts}
    return {verdict: names for verdict, names in found.items() if names}


def _named(row: Mapping[Any, Any]) -> str:
    bound = re.search(r"(lower|upper) bound", str(row["verdict"]))
    width = span([float(row["width_percent"])])
    return f"{row['parameter']} ({width} %{f', {bound[0]}' if bound else ''})"


def sentences(tables: Frames) -> list[str]:
    """Return the sentences of the section: verdicts, correlation, misfit, optimisers."""
    said = [verdicts(tables), *_known(tables)]
    return [*said, _correlation(tables), _misfit(tables), _optimisers(tables)]


def _known(tables: Frames) -> list[str]:
    """Name the estimates that lie far from their known values."""
    if "known_values" not in tables:
        return []
    table = tables["known_values"]
    far = [
        f"{row['parameter']} of the {row['fit']} ({row['estimate']:.4g} {row['unit']}, known "
        f"{row['known']:.4g} ± {row['known_sd']:.2g}, {abs(row['away_sd']):.2g} sd)"
        for row in table[table["flag"].notna()].to_dict("records")
    ]
    if not far:
        return ["All estimates are within 2 standard deviations of their known values."]
    return [
        f"More than 2 standard deviations from the known value: {listed(far)}. Check the known "
        "value; else the estimate makes up for something that the model lacks."
    ]


def _correlation(tables: Frames) -> str:
    table = tables["determined"]
    sizes = table["strongest_correlation"].str.extract(r"([\d.]+)$")[0].astype(float)
    if sizes.isna().all():
        return "There is one parameter, hence no correlation."
    row = table.iloc[int(sizes.argmax())]
    partner, value = str(row["strongest_correlation"]).split(" ")
    return f"The strongest correlation is that of {row['parameter']} and {partner}, {value}."


def _misfit(tables: Frames) -> str:
    groups = tables["noise"].groupby("fit", sort=False)
    return " ".join(_misfit_of(str(fit), rows) for fit, rows in groups)


def _misfit_of(fit: str, table: pd.DataFrame) -> str:
    fits = table["chi2_per_point"].max() <= _FITS
    shown = table if fits else table[table["chi2_per_point"] > _FITS]
    said = listed(
        [
            f"{row['chi2_per_point']:#.2g} ({row['experiment']}, {row['signal']})"
            for row in shown.to_dict("records")
        ]
    )
    if fits:
        return f"The optimum of the {fit} fits within the noise: chi-square per point is {said}."
    text = f"The optimum of the {fit} does not fit within the noise: chi-square per point is {said}"
    if (table["chi2_per_point"] * table["points"]).sum() > table["points"].sum():
        text += "; the intervals are widened by the root of chi-square per degree of freedom"
    return f"{text}. What the model lacks exceeds the noise: the true values may be missed."


def _optimisers(tables: Frames) -> str:
    table = tables["distances"]
    parts = []
    for label, rows in table.groupby("set", sort=False):
        sizes = rows["distance_sd"]
        parts.append(f"{label} {span(sizes)} sd (chi-square {span(rows['chi2_per_freedom'])})")
    return (
        "Distance of the cost functions' sets from this optimum in their farthest parameter, and "
        f"chi-square per degree of freedom: {'; '.join(parts)}."
    )
